// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sides of all triangles of a surface, edge by edge.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
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

/// All sides of all triangles. The sides on one edge follow each other.
inline std::vector<OrientedSide> sorted_sides(
    std::span<const std::array<std::uint32_t, 3>> triangles) {
    std::vector<OrientedSide> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& v = triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i];
            const std::uint32_t b = v[(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const OrientedSide& a, const OrientedSide& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
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
