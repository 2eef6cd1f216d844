// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <nestgrid/shape.hpp>
#include <walk/gradient.hpp>

namespace nestgrid::engine {

/// The slopes of functions in an element: those of the affine functions that fit their values at
/// the corners best, which on simplices are the functions themselves.
class AffineSlopes {
public:
    AffineSlopes(std::span<const Point> x, std::size_t dimension) : corners_{x.size()} {
        Point middle{0, 0, 0};
        for (const Point& corner : x) middle = middle + corner;
        middle = (1 / static_cast<double>(corners_)) * middle;
        std::array<Point, 3> moments{};  // a symmetric matrix
        for (std::size_t k = 0; k < corners_; ++k) {
            weight_[k] = x[k] - middle;
            for (std::size_t d = 0; d < 3; ++d) {
                moments[d] = moments[d] + weight_[k][d] * weight_[k];
            }
        }
        if (dimension < 3) complete(moments, dimension);
        const DualVectors inverse = dual_vectors(moments, 3);
        for (std::size_t k = 0; k < corners_; ++k) {
            const Point w = weight_[k];
            weight_[k] = inverse.gradient({w[0], w[1], w[2]});
        }
    }

    /// \param value value(k) is that at corner k
    template <class Value>
    double slope(const Value& value) const {
        Point gradient{0, 0, 0};
        for (std::size_t k = 0; k < corners_; ++k) gradient = gradient + value(k) * weight_[k];
        return norm(gradient);
    }

private:
    /// Makes the moments of a flat element invertible, by its normal.
    void complete(std::array<Point, 3>& moments, std::size_t dimension) const {
        if (dimension != 2) return;
        Point normal = cross(weight_[1] - weight_[0], weight_[2] - weight_[0]);
        const double length = norm(normal);
        if (length == 0) return;
        normal = (1 / length) * normal;
        const double size = moments[0][0] + moments[1][1] + moments[2][2];
        for (std::size_t d = 0; d < 3; ++d) moments[d] = moments[d] + (size * normal[d]) * normal;
    }

    std::size_t corners_;
    std::array<Point, max_corners> weight_;
};

}  // namespace nestgrid::engine
