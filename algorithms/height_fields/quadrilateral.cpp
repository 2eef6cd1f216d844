// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/quadrilateral.hpp>

#include <algorithm>

#include <contours/cell_contour.hpp>

namespace nestgrid::engine {

namespace {

constexpr double rounding_of_sides = 1e-12;

/// -1 where a is less than b, 1 where it is greater, 0 where they differ by rounding only.
int compare(double a, double b) {
    if (std::abs(a - b) <= rounding_of_sides * std::max(std::abs(a), std::abs(b))) return 0;
    return a < b ? -1 : 1;
}

double squared_distance(const Point& a, const Point& b) { return dot(b - a, b - a); }

}  // namespace

std::array<bool, 2> dividing_diagonals(QuadrilateralCorners x) {
    const auto turn = [&](std::size_t before, std::size_t at, std::size_t behind) {
        return cross(x[at] - x[before], x[behind] - x[at]);
    };
    return {dot(turn(0, 1, 3), turn(3, 2, 0)) > 0, dot(turn(1, 3, 2), turn(2, 0, 1)) > 0};
}

std::size_t shorter_diagonal(QuadrilateralCorners x, const std::array<double, 4>& u,
                             const GraphShape& shape) {
    const auto at = [&](std::size_t i) { return shape.lifted(x[i], u[i]); };
    int order = compare(squared_distance(at(0), at(3)), squared_distance(at(1), at(2)));
    if (order == 0) order = compare(std::abs(u[0] - u[3]), std::abs(u[1] - u[2]));
    if (order != 0) return order < 0 ? 0 : 1;
    const auto least = std::ranges::min_element(x) - x.begin();
    return least == 0 || least == 3 ? 0 : 1;
}

/// With the best affine function subtracted, |U| is at most some r at the corners, so also where it
/// is interpolated, whatever the shapes; the difference is at most 2 r. In a parallelogram that is
/// divided into quadrilaterals it is at most r = twist, and a quarter of that around a centre.
double quadrilateral_chord(QuadrilateralCorners x, const std::array<double, 4>& u, bool nested,
                           bool centred) {
    const Point skew = (x[0] - x[1]) - (x[2] - x[3]);
    if (nested && norm(skew) <= rounding_of_sides * norm(x[3] - x[0])) {
        return centred ? twist(u) / 4 : twist(u);
    }
    return 2 * affine_residual(x, std::span(u));
}

}  // namespace nestgrid::engine
