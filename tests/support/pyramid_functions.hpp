// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finite elements of any degree on a pyramid, apart from those of the library.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid_test {

using nestgrid::Point;

/// The functions of degree p on a pyramid: z^k (1 - z)^(p - k) times polynomials of degree p - k in
/// each of x / (1 - z) and y / (1 - z), by their values on the lattice of all (i, j, k) / p with
/// i, j <= p - k. They are polynomials of degree p on all faces.
class PyramidFunctions {
public:
    static const PyramidFunctions& of(int degree) {
        static std::map<int, PyramidFunctions> known;
        return known.try_emplace(degree, degree).first->second;
    }
    explicit PyramidFunctions(int degree) : degree_{degree} {
        for (int k = 0; k <= degree; ++k) {
            for (int j = 0; j <= degree - k; ++j) {
                for (int i = 0; i <= degree - k; ++i) places_.push_back({i, j, k});
            }
        }
        // Gauss and Jordan, from values on the lattice to factors of the functions.
        const std::size_t n = places_.size();
        for (const auto& [i, j, k] : places_) {
            rows_.push_back(values({i / double(degree), j / double(degree), k / double(degree)}));
            rows_.back().resize(2 * n);
            rows_.back()[n + rows_.size() - 1] = 1;
        }
        for (std::size_t c = 0; c < n; ++c) {
            std::size_t pivot = c;
            for (std::size_t r = c; r < n; ++r) {
                if (std::abs(rows_[r][c]) > std::abs(rows_[pivot][c])) pivot = r;
            }
            std::swap(rows_[c], rows_[pivot]);
            for (std::size_t k = 2 * n; k-- > c;) rows_[c][k] /= rows_[c][c];
            for (std::size_t r = 0; r < n; ++r) {
                const double by = rows_[r][c];
                if (r == c || by == 0) continue;
                for (std::size_t k = c; k < 2 * n; ++k) rows_[r][k] -= by * rows_[c][k];
            }
        }
    }
    const std::vector<std::array<int, 3>>& places() const { return places_; }
    std::vector<double> factors(const std::vector<double>& at_places) const {
        const std::size_t n = places_.size();
        std::vector<double> result(n, 0.0);
        for (std::size_t r = 0; r < n; ++r) {
            for (std::size_t c = 0; c < n; ++c) result[r] += rows_[r][n + c] * at_places[c];
        }
        return result;
    }
    std::vector<double> values(const Point& x) const {
        const double width = 1 - x[2];
        const double a = width > 0 ? x[0] / width : 0;
        const double b = width > 0 ? x[1] / width : 0;
        std::vector<double> result;
        for (const auto& [i, j, k] : places_) {
            const int left = degree_ - k;
            result.push_back(bernstein(degree_, k, x[2]) * bernstein(left, i, a) *
                             bernstein(left, j, b));
        }
        return result;
    }

private:
    static double bernstein(int degree, int i, double x) {
        double value = std::pow(x, i) * std::pow(1 - x, degree - i);
        for (int m = 1; m <= i; ++m) value *= double(degree - i + m) / m;
        return value;
    }

    int degree_;
    std::vector<std::array<int, 3>> places_;
    std::vector<std::vector<double>> rows_;
};

}  // namespace nestgrid_test
