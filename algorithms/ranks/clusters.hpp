// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The clusters of strong vertices of a surface in pieces, and which rank merges each
// (merge_across.hpp).
#pragma once

#include <optional>

#include <nestgrid/detail/union_find.hpp>
#include <ranks/connected_parts.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

class Clusters {
public:
    static constexpr int here = -1;

    /// Collective.
    /// \param at_nodes all vertices of the piece that any rank knows to be at a node
    Clusters(Ranks& ranks, const Surface<3>& piece, const VerticesAtNodes& at_nodes,
             std::span<const VertexCopy> copies);

    /// The rank that merges the cluster of some vertices of one triangle; `here` where no other
    /// rank has anything of it, and where none of the vertices is strong.
    int rank_of(std::span<const std::uint32_t> vertices) const;

private:
    void find_strong(const Surface<3>& piece, const VerticesAtNodes& at_nodes);
    void join(const Surface<3>& piece);

    std::vector<bool> strong_;  // by vertex
    nestgrid::detail::UnionFind classes_;
    std::vector<std::uint32_t> cluster_;  // by vertex
    std::optional<ConnectedParts> across_;
};

}  // namespace nestgrid::engine
