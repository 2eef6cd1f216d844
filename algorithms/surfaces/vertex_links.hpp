// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The links of vertices: the sides of triangles opposite a vertex.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <surfaces/collinear_triangles.hpp>

namespace nestgrid::engine {

/// The side opposite a vertex in a triangle.
struct OppositeSide {
    std::array<std::uint32_t, 2> edge;
    std::uint32_t triangle;
};
using VertexLink = std::span<const OppositeSide>;

/// Whether the link is one path or one ring. Requires that no two sides begin, and no two end, at
/// one vertex.
bool is_one_fan(VertexLink link);

class VertexLinks {
public:
    /// Finds the links of some vertices in the place of those it has. Keeps its memory.
    /// \param wanted by vertex: whether to find its link
    void find(std::span<const NumberedTriangle> triangles, const std::vector<bool>& wanted);

    /// Calls function(vertex, link) for each vertex that has a link.
    template <class Function>
    void for_each(Function&& function) const {
        for (std::uint32_t v = 0; v + 1 < first_.size(); ++v) {
            const std::uint32_t first = first_[v];
            const std::uint32_t last = first_[v + 1U];
            if (first != last) function(v, VertexLink(sides_).subspan(first, last - first));
        }
    }

private:
    std::vector<OppositeSide> sides_;   // of the first vertex, the second, ...
    std::vector<std::uint32_t> first_;  // by vertex: its first one in sides_
};

}  // namespace nestgrid::engine
