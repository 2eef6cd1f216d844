// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points all over the triangles of a surface.
#pragma once

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/detail/geometry.hpp>

namespace nestgrid_test {

/// Points of a triangle, corners and sides included.
inline std::vector<Point> samples_of(const std::array<Point, 3>& x, int steps) {
    std::vector<Point> points;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; i + j <= steps; ++j) {
            const double a = static_cast<double>(i) / steps;
            const double b = static_cast<double>(j) / steps;
            points.push_back(a * x[0] + b * x[1] + (1 - a - b) * x[2]);
        }
    }
    return points;
}

inline std::array<Point, 3> corners_of(const Surface<3>& s, std::size_t triangle) {
    const auto& [a, b, c] = s.simplices[triangle];
    return {s.vertices[a], s.vertices[b], s.vertices[c]};
}

/// Every vertex on the boundary lies on a face of the unit cube.
inline void expect_borders_on_cube(const Surface<3>& s) {
    for (const auto& edge : s.boundary) {
        for (const std::uint32_t v : edge) {
            double nearest = 1;
            for (const double at : s.vertices[v]) {
                nearest = std::min({nearest, std::abs(at), std::abs(1 - at)});
            }
            EXPECT_LE(nearest, 1e-9);
        }
    }
}

}  // namespace nestgrid_test
