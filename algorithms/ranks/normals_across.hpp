// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of a surface in pieces: those of one rank, to the last bit.
//
// The gradient at a node is the mean over the elements around it that are drawn, summed up in the
// order in which one rank draws them. So ranks tell each other the terms at nodes that they share,
// with the place of their element in the walk, and each sums them up in that order.
// A vertex that one rank adopted from another may lie between nodes of which it knows nothing: it
// takes the normal from a rank that knows both.
// A normal agrees with all triangles around its vertex. So ranks tell each other the triangles
// around vertices that both have.
#pragma once

#include <ranks/shared_nodes.hpp>
#include <ranks/vertex_copies.hpp>
#include <ranks/walk_place.hpp>
#include <surfaces/node_gradients.hpp>

namespace nestgrid::engine {

/// Terms of gradients at shared nodes.
class SharedGradients {
public:
    /// \param place of the element whose term this is
    void add(NodeKey node, const WalkPlace& place, const CornerGradient& gradient) {
        terms_.push_back({node, place, gradient});
    }
    void append(const SharedGradients& other) {
        terms_.insert(terms_.end(), other.terms_.begin(), other.terms_.end());
    }
    void clear() { terms_.clear(); }
    /// Sums up the terms of all ranks. Collective.
    void sum_up(const SharedNodes& shared, NodeGradients& sums);

private:
    struct Term {
        NodeKey node;
        WalkPlace place;
        CornerGradient gradient;
    };
    std::vector<Term> terms_;
};

/// Replaces normals by those of ranks that know more of them. Collective.
/// \param known of each vertex: between how many nodes with gradients it lies
void share_normals(Ranks& ranks, std::span<const VertexCopy> copies, std::span<std::uint8_t> known,
                   std::span<Point> normals);

/// settle_normals() with the triangles of all ranks around each vertex. Collective.
void settle_normals_across(Ranks& ranks, std::span<const VertexCopy> copies,
                           std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const Point> x, std::vector<Point>& normals);

}  // namespace nestgrid::engine
