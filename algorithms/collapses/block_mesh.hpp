// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A part of a surface on which edges are collapsed: its triangles, and what is around them.
//
// Invariants:
//   - a vertex that moves has all of its triangles in the block;
//   - obstacles are triangles that stay as they are and touch what moves at most in vertices that
//     do not.
#pragma once

#include <cstdint>
#include <vector>

#include <boost/container/small_vector.hpp>

#include <collapses/colours.hpp>
#include <collapses/near_parts.hpp>

namespace nestgrid::engine {

/// A vertex of a surface that is being collapsed.
struct CollapsingVertex {
    Point x{};  ///< from the middle of the surface
    Quadric quadric;
    Colours colours;  ///< none where the place alone counts
    Freedom freedom;
    std::uint32_t drawn = moved;  ///< number of the vertex that was drawn there
    bool moves = true;
    bool on_border = false;    ///< on an edge of one triangle only
    bool at_boundary = false;  ///< of the domain: not at a crack

    static constexpr std::uint32_t moved = ~std::uint32_t{0};  // none was
};

/// One of the places that are tried for the point that an edge is collapsed to, with its colours.
struct CollapsePlace {
    Point x;
    ColourValues colours;
};

/// A triangle around the ends of an edge that is to be collapsed into a point w.
struct StarTriangle {
    std::uint32_t triangle;
    std::uint32_t centre;  ///< the end that is a corner of it
    std::uint32_t a;       ///< the next corner
    std::uint32_t b;       ///< the last one
    bool goes;             ///< both ends are corners: it vanishes
};

class BlockMesh {
public:
    using Corners = std::array<std::uint32_t, 3>;
    using Star = boost::container::small_vector<StarTriangle, 24>;
    static constexpr std::uint32_t gone = ~std::uint32_t{0};  // first corner of such a triangle

    std::vector<CollapsingVertex> vertices;
    std::vector<Corners> triangles;
    std::size_t own = 0;  ///< the first triangles, which are no obstacles
    /// By own triangle, the parts of another surface that it is near to. Empty where there is none.
    std::vector<std::vector<NearPart>> parts;

    /// Lists positions, and the triangles around each vertex.
    void connect();

    const Point& x(std::uint32_t vertex) const { return position_[vertex]; }
    bool exists(std::uint32_t vertex) const { return !around_[vertex].empty(); }
    Triangle corners(std::uint32_t triangle) const {
        const auto& [a, b, c] = triangles[triangle];
        return {x(a), x(b), x(c)};
    }
    Point normal(std::uint32_t triangle) const {
        const auto& [a, b, c] = triangles[triangle];
        return cross(x(b) - x(a), x(c) - x(a));
    }
    std::span<const std::uint32_t> around(std::uint32_t vertex) const {
        return {around_[vertex].data(), around_[vertex].size()};
    }
    /// The triangles around both ends of an edge, each once.
    void find_star(std::uint32_t u, std::uint32_t v, Star& star) const;
    /// Whether the surface stays a manifold of the same kind: the vertices that both ends have for
    /// neighbours are those opposite the edge (the link condition).
    bool keeps_manifold(std::uint32_t u, std::uint32_t v, const Star& star);
    /// Moves u to a place, lets v vanish in it, and joins their quadrics.
    void collapse(std::uint32_t u, std::uint32_t v, const CollapsePlace& place);
    /// The neighbours of a vertex, each once.
    std::span<const std::uint32_t> neighbours(std::uint32_t vertex);

private:
    using Around = boost::container::small_vector<std::uint32_t, 8>;

    std::vector<Point> position_;  // side by side, as they are read most
    std::vector<Around> around_;
    std::vector<std::uint8_t> mark_;
    std::vector<std::uint32_t> neighbours_;
};

}  // namespace nestgrid::engine
