// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The planes and straight borders of a surface, which its vertices keep when only its colours are
// to change.
//
// Triangles that follow each other in a plane are a face. A vertex inside of a face may move in its
// plane, one on a straight edge between two faces along that, one on a straight border along the
// border, any other one not at all. Invariant: where triangles change only so, and none turns over,
// the surface consists of the same points as before, up to rounding.
#pragma once

#include <collapses/border_planes.hpp>

namespace nestgrid::engine {

/// How the vertices of a surface may move, by vertex; where more than two triangles, or such of
/// different orientation, meet at an edge, not at all.
std::vector<Freedom> support_freedom(const Surface<3>& surface);

}  // namespace nestgrid::engine
