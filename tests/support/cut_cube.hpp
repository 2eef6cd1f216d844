// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The polygon in which a plane cuts the unit cube.
#pragma once

#include <cmath>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Clips a polygon by the half-space dot(normal, x) >= offset.
inline std::vector<Point> clipped(const std::vector<Point>& polygon, const Point& normal,
                                  double offset) {
    std::vector<Point> result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& a = polygon[i];
        const Point& b = polygon[(i + 1) % polygon.size()];
        const double at_a = dot(normal, a) - offset;
        const double at_b = dot(normal, b) - offset;
        if (at_a >= 0) result.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) result.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    return result;
}

/// The area of the part of a plane in the unit cube.
inline double area_in_cube(const Point& through, const Point& normal) {
    const Point n = (1 / nestgrid::norm(normal)) * normal;
    const Point other = std::abs(n[0]) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
    const Point u = cross(n, other);
    const Point p = 10 / nestgrid::norm(u) * u;
    const Point q = cross(n, p);
    std::vector<Point> polygon{through + p, through + q, through - p, through - q};
    for (std::size_t d = 0; d < 3; ++d) {
        Point axis{};
        axis[d] = 1;
        polygon = clipped(polygon, axis, 0);
        polygon = clipped(polygon, -1.0 * axis, -1);
    }
    Point area{};
    for (std::size_t i = 2; i < polygon.size(); ++i) {
        area = area + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    }
    return nestgrid::norm(area) / 2;
}

}  // namespace nestgrid_test
