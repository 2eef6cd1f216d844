// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The standard refinement rules. Each is built on first use, checked, and lives until the program
// ends; ask for those you need in the constructor of your grid, not in split().
//
// Elements that share a face must divide it by the same nodes. These go with each other:
//   - red_rule() of all shapes, which are red_triangle_rule(), red_tetrahedron_rule() with any
//     diagonal, dyadic_rule(), and rules of their own for pyramids and prisms;
//   - prism_rule() of all kinds, among prisms and beside red triangles: not beside hexahedra and
//     pyramids, nor beside red_rule() of prisms;
//   - bisection_rule() of all tags, where the tags are compatible.
#pragma once

#include <nestgrid/rule.hpp>

namespace nestgrid {

/// Maubach's bisection of a simplex with the tag `tag` (1995): the edge from corner 0 to corner
/// `tag` is cut at its midpoint z. With the corners x0 ... xn the children are
///     x0 ... x(tag-1)  z  x(tag+1) ... xn    and    x1 ... x(tag)  z  x(tag+1) ... xn ;
/// both carry the tag tag - 1, or n after 1. The second one is mirrored where `tag` is odd.
/// \param shape triangle or tetrahedron; \param tag 1 ... dimension.
const Rule& bisection_rule(Shape shape, int tag);

/// Red refinement of a triangle into four.
const Rule& red_triangle_rule();

/// Red refinement of a tetrahedron into eight. The inner octahedron is cut along the diagonal from
/// the midpoint of the edge 02 to that of the edge 13 (diagonal 0: with Bey's numbering, 1995,
/// three classes of similar tetrahedra at most), of 01 to 23 (diagonal 1), or of 03 to 12 (diagonal
/// 2).
const Rule& red_tetrahedron_rule(int diagonal = 0);

/// Refinement of a segment, quadrilateral or hexahedron into 2, 4 or 8 by halving every direction.
/// New nodes: first the midpoints of the edges in the order of the topology, then the centres of
/// the quadrilateral faces in the order of the topology, then the centre.
const Rule& dyadic_rule(Shape shape);

/// Refinement of any shape that divides all edges and faces alike: every edge at its midpoint,
/// every triangle into four, every quadrilateral into four around the mean of its corners. A
/// pyramid becomes six pyramids and four tetrahedra, a prism eight prisms.
///
/// \throw InvalidInput for a point
const Rule& red_rule(Shape shape);

/// How a prism, triangle times segment, is refined.
enum class PrismSplit : std::uint8_t { isotropic, horizontal, vertical };

/// Refinement of a prism into four along the triangle (horizontal), two along the segment
/// (vertical), or eight. The isotropic rule is horizontal, then vertical: the node in the middle of
/// a quadrilateral face lies between the midpoints of its lower and upper edge.
const Rule& prism_rule(PrismSplit split);

}  // namespace nestgrid
