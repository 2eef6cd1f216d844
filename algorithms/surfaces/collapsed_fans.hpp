// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Removes fans that merging at nodes has laid onto a line.
#pragma once

#include <vector>

#include <surfaces/node_classes.hpp>

namespace nestgrid::engine {

/// Replaces each fan around a vertex that is not merged, all of whose triangles are collapsed and
/// have two merged vertices, by triangles between the vertices around it. A triangle is collapsed
/// where some, but not all of its vertices are merged, and they lie on one line.
/// \return by vertex: whether it is merged, or a collapsed triangle had it
std::vector<bool> remove_collapsed_fans(std::vector<NumberedTriangle>& triangles,
                                        const NodeClasses& classes);

}  // namespace nestgrid::engine
