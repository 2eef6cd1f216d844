// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines on any triangulated surface whose vertices carry attributes: a slice, an isosurface.
//
// Invariants:
//   - a vertex is inside where its attribute is at least the isovalue; an edge with one end inside
//     has one vertex of the line, placed from its lower to its higher value;
//   - a triangle with such edges has one segment, from the side on which the attribute falls to the
//     side on which it rises, counterclockwise. The other triangle at a side runs along it the
//     other way, so that its segment begins where this one ends.
// Consequence: on an oriented manifold every line is a ring, or begins and ends on edges of one
// triangle only; isovalues equal to attributes of vertices are no special case.
#pragma once

#include <span>

#include <nestgrid/algorithms/polylines.hpp>

namespace nestgrid {

/// The lines on a surface on which one attribute has the given values, in one pass. Seen from the
/// side to which the normals of the triangles point, the attribute is higher on the left. Vertices
/// carry all attributes of the surface. Takes time proportional to the size of the surface and of
/// the lines.
/// \param attribute 0 ... the number of attributes of a vertex, less one
/// \param values in any order; the lines come in this order
/// \throw InvalidInput where the surface has no such attribute, where one of its values or an
///        isovalue is not finite, and where a triangle names a vertex that does not exist
Polylines isolines(const Surface<3>& surface, std::size_t attribute,
                   std::span<const double> values);

}  // namespace nestgrid
