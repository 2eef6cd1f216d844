// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether two convex bodies have no common inner point: a plane between them is looked for, by the
// theorem of separating axes.
#pragma once

#include <collapses/strong_nodes.hpp>

namespace nestgrid::engine {

/// Whether a triangle keeps out of a tetrahedron, which may be flat. Corners and sides that both
/// have in common, or that touch, do no harm.
bool separated(const Tetrahedron& body, const Triangle& triangle);
/// Whether two triangles do not pass through, and in one plane do not overlap, each other.
bool separated(const Triangle& a, const Triangle& b);

}  // namespace nestgrid::engine
