// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// The hanging nodes of a hierarchy, by hanging_probe.hpp. Hidden leaves constrain no node.
/// \throw GridError where refinement is anisotropic and nodes hang on others than their parents
template <class Real>
HangingNodes derive_hanging_nodes(const Hierarchy<Real>& hierarchy);

/// Whether the hanging nodes must be derived: the grid neither names them nor is conforming.
template <class Real>
bool hanging_nodes_unknown(const Hierarchy<Real>& hierarchy) {
    return !hierarchy.offers(Feature::constrained) && !hierarchy.facts().conforming;
}

}  // namespace nestgrid::engine
