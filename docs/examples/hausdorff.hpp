// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How far two surfaces are from each other.
#pragma once

#include <algorithm>
#include <limits>

#include <nestgrid/algorithms/surface.hpp>

namespace figures {

using namespace nestgrid;

inline double distance_from(const Point& x, const std::array<Point, 2>& segment) {
    const Point along = segment[1] - segment[0];
    const double square = dot(along, along);
    const double t = square > 0 ? dot(along, x - segment[0]) / square : 0;
    return norm(x - segment[0] - std::clamp(t, 0.0, 1.0) * along);
}

inline double distance_from(const Point& x, const std::array<Point, 3>& t) {
    const Point normal = cross(t[1] - t[0], t[2] - t[0]);
    bool above = dot(normal, normal) > 0;  // x lies above the triangle
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& a = t[i];
        const Point& b = t[(i + 1) % 3];
        above = above && dot(cross(b - a, x - a), normal) >= 0;
        least = std::min(least, distance_from(x, std::array{a, b}));
    }
    return above ? std::abs(dot(normal, x - t[0])) / norm(normal) : least;
}

/// The greatest distance of a vertex of one surface from the other one.
template <int dimension>
double one_sided_distance(const Surface<dimension>& from, const Surface<dimension>& to) {
    constexpr auto corners = static_cast<std::size_t>(dimension);
    double greatest = 0;
    for (const Point& x : from.vertices) {
        double least = std::numeric_limits<double>::infinity();
        for (const auto& simplex : to.simplices) {
            std::array<Point, corners> at;
            for (std::size_t i = 0; i < corners; ++i) at[i] = to.vertices[simplex[i]];
            double size = norm(at[1] - at[0]);
            if constexpr (corners == 3) size = std::max(size, norm(at[2] - at[0]));
            if (norm(x - at[0]) - size > least) continue;
            least = std::min(least, distance_from(x, at));
            if (least <= greatest) break;
        }
        greatest = std::max(greatest, least);
    }
    return greatest;
}

/// The Hausdorff distance of two surfaces that are not empty, measured at their vertices.
template <int dimension>
double hausdorff_distance(const Surface<dimension>& a, const Surface<dimension>& b) {
    return std::max(one_sided_distance(a, b), one_sided_distance(b, a));
}

}  // namespace figures
