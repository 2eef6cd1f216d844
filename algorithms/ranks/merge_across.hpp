// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Merging the vertices at each node (surfaces/merge_at_nodes.hpp) of a surface in pieces.
//
// A vertex is strong where it is at a node, or may come to lie on one line with vertices at nodes
// around it. Merging changes nothing but triangles with strong vertices, and what it does at one
// strong vertex depends on those strong ones alone that triangles join to it: its cluster.
// A cluster that several ranks have is merged by the least of them: the others send the triangles
// around its strong vertices there, and get back what becomes of each. So each rank keeps what it
// drew, and all pieces together are what one rank would make of the whole.
// Memory and time: of the order of the greatest cluster, which is the whole of a slice along the
// nodes of a grid, and a few triangles where a slice meets few nodes.
#pragma once

#include <nestgrid/detail/key_table.hpp>
#include <ranks/shared_nodes.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

/// Collective.
/// \param names of the vertices, the same on all ranks; changed with the vertices
void merge_at_nodes_across(Surface<3>& piece, VerticesAtNodes& at_nodes,
                           std::vector<KeyPair>& names, const SharedNodes& shared);

}  // namespace nestgrid::engine
