// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Splits sides of the triangles of a surface at their middles.
//
// Invariant: a side is split in all its triangles alike, and on the boundary. Consequence: the
// surface has the same points and the same open, boundary and non-manifold edges as before, up to
// their being split.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid::engine {

/// A side of a triangle by its vertices, the lower number first.
class TriangleSide {
public:
    TriangleSide(std::uint32_t a, std::uint32_t b)
        : name_{std::uint64_t{std::min(a, b)} << 32U | std::max(a, b)} {}

    std::uint32_t first() const { return static_cast<std::uint32_t>(name_ >> 32U); }
    std::uint32_t second() const { return static_cast<std::uint32_t>(name_); }
    auto operator<=>(const TriangleSide&) const = default;

private:
    std::uint64_t name_;
};

/// Adds the middle of each side to the vertices, in the order of the sides: with the mean of the
/// attributes at its ends, and of their normals. Each triangle is replaced, where it was, by parts
/// between the middles of its sides, of the same element.
/// Requires a surface without references.
/// \param sides ascending, each once
/// \return by triangle: whether it is a part of one that was split
/// \throw GridError where there are 2^32 vertices or more
std::vector<bool> split_sides(Surface<3>& surface, std::span<const TriangleSide> sides);

}  // namespace nestgrid::engine
