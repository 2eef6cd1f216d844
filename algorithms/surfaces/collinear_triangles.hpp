// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Removes triangles whose three vertices lie on one line.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// A triangle of a surface, and the number of the simplex from which it was made, or `removed`.
struct NumberedTriangle {
    static constexpr std::uint32_t removed = ~std::uint32_t{0};
    std::array<std::uint32_t, 3> v;
    std::uint32_t from;
    bool operator==(const NumberedTriangle&) const = default;
};

/// Erases the triangles that are marked as removed. \return how many there were
inline std::size_t erase_removed(std::vector<NumberedTriangle>& triangles) {
    return std::erase_if(
        triangles, [](const NumberedTriangle& t) { return t.from == NumberedTriangle::removed; });
}

/// Whether a triangle's height is below 1e-9 of its longest side.
bool are_collinear(const Point& a, const Point& b, const Point& c);

/// Removes collinear triangles among those whose vertices all fulfil a condition, by flips of their
/// longest sides, the longest first. Keeps the boundary of the set of triangles, but where it runs
/// along such a side: there it visits the vertex between.
/// \param at positions of the vertices
/// \param candidate the condition
void remove_collinear(std::vector<NumberedTriangle>& triangles,
                      const std::function<Point(std::uint32_t)>& at,
                      const std::function<bool(std::uint32_t)>& candidate);

}  // namespace nestgrid::engine
