// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// The hanging nodes of a hierarchy, by hanging_probe.hpp, with its crossing nodes where it gives
/// parents (crossing_nodes.hpp). Hidden leaves constrain no node.
/// \throw GridError where refinement is anisotropic, and nodes hang on others than their parents,
///        which the grid does not give; or where a node hangs on two edges in two directions
template <class Real>
HangingNodes derive_hanging_nodes(const Hierarchy<Real>& hierarchy);

/// Whether the hanging nodes must be derived: the grid is not conforming, and does not name them,
/// or gives their parents.
template <class Real>
bool hanging_nodes_unknown(const Hierarchy<Real>& hierarchy) {
    return (!hierarchy.offers(Feature::constrained) ||
            hierarchy.offers(Feature::hanging_parents)) &&
           !hierarchy.facts().conforming;
}

}  // namespace nestgrid::engine
