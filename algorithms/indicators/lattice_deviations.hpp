// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Deviations (path_deviations.hpp) on lattices of bisected simplices, by arithmetic on keys: the
// new node of an element has the mean of the keys of its two parents, and all elements of a level
// are split alike. Elements that lie beyond the domain count, too, where those around them do not:
// numbers of nodes on that part of the boundary may be greater than the general walk's.
// Memory: one value for each node, while it runs. Threads take coarse elements; results do not
// depend on them.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid::engine {

/// Whether a hierarchy is such a lattice: looks at one split of each kind.
template <class Real>
bool bisects_by_keys(const Hierarchy<Real>& hierarchy);

/// Fills the dense entries, which have room. Requires bisects_by_keys().
template <class Real>
void sweep_lattice_deviations(const Hierarchy<Real>& hierarchy, const Spread& spread,
                              detail::IndicatorEntries& entries, const Executor& executor);

}  // namespace nestgrid::engine
