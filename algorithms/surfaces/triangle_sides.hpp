// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sides of all triangles of a surface, edge by edge.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace nestgrid::engine {

/// One side of a triangle, ends ascending; `forward` where the triangle runs along it upwards.
struct OrientedSide {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t triangle;
    bool forward;

    auto ends() const { return std::pair(low, high); }
};

/// Calls function(side) for all sides of all triangles, one triangle after the other.
template <class Function>
void for_each_side(std::span<const std::array<std::uint32_t, 3>> triangles,
                   const Function& function) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& v = triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i];
            const std::uint32_t b = v[(i + 1) % 3];
            function(OrientedSide{std::min(a, b), std::max(a, b), t, a < b});
        }
    }
}

/// All sides of all triangles. The sides on one edge follow each other, in the order of their
/// triangles. Vertices may have any numbers, but those of few triangles should not be far apart.
inline std::vector<OrientedSide> sorted_sides(
    std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::size_t vertices = 0;
    for_each_side(triangles, [&](const OrientedSide& side) {
        vertices = std::max(vertices, std::size_t{side.low} + 1);
    });
    // Where the sides of each lower end begin, and then where the next of them goes.
    std::vector<std::size_t> next(vertices + 1, 0);
    for_each_side(triangles, [&](const OrientedSide& side) { ++next[side.low + 1]; });
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<OrientedSide> sides(3 * triangles.size());
    for_each_side(triangles, [&](const OrientedSide& side) { sides[next[side.low]++] = side; });
    std::size_t begin = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::span<OrientedSide> around(sides.data() + begin, next[v] - begin);
        std::sort(around.begin(), around.end(), [](const OrientedSide& a, const OrientedSide& b) {
            return std::tie(a.high, a.triangle) < std::tie(b.high, b.triangle);
        });
        begin = next[v];
    }
    return sides;
}

/// Calls function(sides of the edge) for every edge, of sides as sorted_sides() returns them.
template <class Function>
void for_each_edge(std::span<const OrientedSide> sides, Function&& function) {
    for (std::span<const OrientedSide> rest = sides; !rest.empty();) {
        const auto other = std::find_if(rest.begin(), rest.end(), [&](const OrientedSide& side) {
            return side.ends() != rest.front().ends();
        });
        const auto count = static_cast<std::size_t>(other - rest.begin());
        function(rest.first(count));
        rest = rest.subspan(count);
    }
}

}  // namespace nestgrid::engine
