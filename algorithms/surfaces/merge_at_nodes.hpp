// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Puts one vertex at a node in the place of the slivers around it.
//
// Where a node has the value of the level, the half-open contour cuts all edges at the node next to
// it. Renaming these cuts to the node is a simplicial map: it commutes with the boundary operator,
// and triangles that repeat a vertex vanish, so that every edge keeps as many triangles one way as
// the other. What remains to be done:
//   - a fan around a vertex inside an element vanishes where all nodes around it lie on one line
//     with the vertex (collapsed_fans.hpp);
//   - triangles with three nodes on one line vanish, and the triangle beyond the edge between the
//     outer two nodes is divided at the inner one (collinear_triangles.hpp);
//   - two triangles with the same vertices and opposite orientations vanish together;
//   - where two triangles would run along an edge the same way, or two fans meet in a vertex, the
//     cuts at the nodes there keep their places (node_classes.hpp). So the surface stays a
//     manifold.
#pragma once

#include <nestgrid/algorithms/surface.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

constexpr std::uint32_t dropped = ~std::uint32_t{0};

/// Merges the vertices at each node that are connected by edges between them. Drops vertices that
/// no triangle is left to. An edge with a merged vertex is on the boundary afterwards where one
/// triangle alone has it.
/// Requires a manifold without references, closed inside the domain. The result does not depend on
/// the numbers of vertices and triangles.
/// \return by vertex: its number afterwards, or `dropped`; nothing where no vertex is at a node,
/// and
///         all keep their numbers
std::vector<std::uint32_t> merge_at_nodes(Surface<3>& surface, const VerticesAtNodes& at_nodes);

}  // namespace nestgrid::engine
