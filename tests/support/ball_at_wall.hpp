// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A ball that the wall x = 0 of the unit cube cuts, and how far a surface is from its sphere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/detail/geometry.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Negative inside.
struct BallAtWall {
    Point centre{0.2, 0.5, 0.5};
    double radius = 0.4;

    double operator()(const Point& x) const { return norm(x - centre) - radius; }

    /// Relative errors of the area and of the volume of a surface, and the greatest distance of a
    /// vertex from the sphere.
    std::array<double, 3> errors_of(const Surface<3>& surface) const {
        std::array<double, 3> sum{};  // area, volume, distance
        const Point in_wall{0, 0.5, 0.5};
        for (const auto& [a, b, c] : surface.simplices) {
            const Point& x = surface.vertices[a];
            const Point normal = cross(surface.vertices[b] - x, surface.vertices[c] - x);
            sum[0] += norm(normal) / 2;
            sum[1] += dot(x - in_wall, normal) / 6;
            sum[2] = std::max(sum[2], std::abs((*this)(x)));
        }
        const double height = radius + centre[0];
        const double pi = std::acos(-1.0);
        return {std::abs(sum[0] / (2 * pi * radius * height) - 1),
                std::abs(std::abs(sum[1]) * 3 / (pi * height * height * (3 * radius - height)) - 1),
                sum[2]};
    }
};

}  // namespace nestgrid_test
