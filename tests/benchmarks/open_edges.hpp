// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Cracks in triangle surfaces, whoever made them.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// What the edges of a triangle surface in the unit cube are used by.
struct EdgeCount {
    std::size_t triangles = 0;
    std::size_t open = 0;         ///< edges of one triangle, not on the boundary of the cube
    std::size_t nonmanifold = 0;  ///< edges of more than two
};

using Triangles = std::vector<std::array<std::size_t, 3>>;

/// Vertices within 1e-10 of each other are made one, for programs that do not number them.
inline void merge(std::vector<Point>& vertices, Triangles& triangles) {
    std::map<std::array<long long, 3>, std::size_t> vertex_of;
    std::vector<Point> merged;
    std::vector<std::size_t> number;
    for (const Point& x : vertices) {
        const std::array<long long, 3> at{std::llround(x[0] * 1e10), std::llround(x[1] * 1e10),
                                          std::llround(x[2] * 1e10)};
        const auto [found, is_new] = vertex_of.insert({at, merged.size()});
        if (is_new) merged.push_back(x);
        number.push_back(found->second);
    }
    for (auto& t : triangles) t = {number[t[0]], number[t[1]], number[t[2]]};
    vertices = std::move(merged);
}

/// Edges by the numbers of their vertices; triangles that lost a vertex are left out.
inline EdgeCount count_edges(const std::vector<Point>& vertices, const Triangles& triangles) {
    std::map<std::pair<std::size_t, std::size_t>, int> uses;
    EdgeCount row;
    for (const auto& v : triangles) {
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
        ++row.triangles;
        for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(v[i], v[(i + 1) % 3])];
    }
    const auto on_boundary = [&](std::size_t a, std::size_t b) {
        for (std::size_t d = 0; d < 3; ++d) {
            for (const double side : {0.0, 1.0}) {
                if (std::abs(vertices[a][d] - side) < 1e-9 &&
                    std::abs(vertices[b][d] - side) < 1e-9) {
                    return true;
                }
            }
        }
        return false;
    };
    for (const auto& [edge, n] : uses) {
        row.open += n == 1 && !on_boundary(edge.first, edge.second) ? 1 : 0;
        row.nonmanifold += n > 2 ? 1 : 0;
    }
    return row;
}

}  // namespace nestgrid
