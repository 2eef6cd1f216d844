// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Several gradients at once. Loops over lanes have constant bounds, so that compilers vectorise
// them.
#pragma once

#include <array>
#include <cmath>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// In each lane a function that is known by its differences along the axes of an element.
template <std::size_t lanes>
class GradientLanes {
public:
    static constexpr std::size_t count = lanes;
    using Lanes = std::array<double, count>;

    /// Sets axis d of a lane, and by how much the function rises along it.
    void set(std::size_t lane, std::size_t d, const Point& along, double rise) {
        for (std::size_t c = 0; c < 3; ++c) along_[d][c][lane] = along[c];
        rise_[d][lane] = rise;
    }

    /// Computes the gradients, times a factor; 0 where the axes of a lane span nothing. Elements of
    /// dimension 2 and 1 may lie in space. Lanes whose axes were not set have no meaning.
    void solve(int dimension, double factor) {
        if (dimension == 1) {
            solve_line(factor);
            return;
        }
        if (dimension == 2) put_normals();
        const auto& [x, y, z] = along_;
        std::array<std::array<Lanes, 3>, 3> dual;
        cross(y, z, dual[0]);
        cross(z, x, dual[1]);
        cross(x, y, dual[2]);
        Lanes by;
        for (std::size_t l = 0; l < count; ++l) {
            const double volume =
                x[0][l] * dual[0][0][l] + x[1][l] * dual[0][1][l] + x[2][l] * dual[0][2][l];
            by[l] = volume == 0 ? 0 : factor / volume;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t l = 0; l < count; ++l) {
                const double sum = rise_[0][l] * dual[0][c][l] + rise_[1][l] * dual[1][c][l];
                result_[c][l] = by[l] * (sum + rise_[2][l] * dual[2][c][l]);
            }
        }
    }
    /// The coordinates of the results, by lane.
    std::array<Lanes, 3>& result() { return result_; }

private:
    using Vectors = std::array<Lanes, 3>;  // by coordinate

    static void cross(const Vectors& a, const Vectors& b, Vectors& out) {
        for (std::size_t l = 0; l < count; ++l) {
            out[0][l] = a[1][l] * b[2][l] - a[2][l] * b[1][l];
            out[1][l] = a[2][l] * b[0][l] - a[0][l] * b[2][l];
            out[2][l] = a[0][l] * b[1][l] - a[1][l] * b[0][l];
        }
    }
    /// Makes the unit normal of the first two axes the third one, along which nothing rises.
    void put_normals() {
        Vectors& z = along_[2];
        cross(along_[0], along_[1], z);
        for (std::size_t l = 0; l < count; ++l) {
            const double area =
                std::sqrt(z[0][l] * z[0][l] + z[1][l] * z[1][l] + z[2][l] * z[2][l]);
            const double by = area == 0 ? 0 : 1 / area;
            for (std::size_t c = 0; c < 3; ++c) z[c][l] *= by;
            rise_[2][l] = 0;
        }
    }
    void solve_line(double factor) {
        const Vectors& x = along_[0];
        for (std::size_t l = 0; l < count; ++l) {
            const double square = x[0][l] * x[0][l] + x[1][l] * x[1][l] + x[2][l] * x[2][l];
            const double by = square == 0 ? 0 : factor * rise_[0][l] / square;
            for (std::size_t c = 0; c < 3; ++c) result_[c][l] = by * x[c][l];
        }
    }

    std::array<Vectors, 3> along_{};
    std::array<Lanes, 3> rise_{};
    Vectors result_{};
};

}  // namespace nestgrid::engine
