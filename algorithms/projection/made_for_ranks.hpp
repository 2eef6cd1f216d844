// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The one place that decides what is drawn on distributed grids, and what is refused. The table in
// docs/distributed.md says the same.
//
// Whatever does not ask here is refused: a walk over a distributed grid must say that it is made
// for it (Needs::on_ranks).
#pragma once

#include <string>

#include <contours/level.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid::engine {

using nestgrid::detail::refuse_on_ranks;

/// Whether this process has all leaves of the grid.
template <class Real>
bool has_all_leaves(const Hierarchy<Real>& hierarchy);

/// \throw GridError where elements are elsewhere and the grid has no ranks
/// \throw InvalidInput where it has, and the walk is not made for them
template <class Real>
void require_made_for_parts(const Hierarchy<Real>& hierarchy, bool on_ranks);

/// What looks at elements without a Walk, and is not made for ranks, calls this.
template <class Real>
void require_whole_grid(const Hierarchy<Real>& hierarchy) {
    if (hierarchy.offers(Feature::presence)) require_made_for_parts(hierarchy, false);
}

/// \throw GridError where the grid has changed since its ranks shared their nodes
template <class Real>
void require_same_state(const Hierarchy<Real>& hierarchy);

/// \throw InvalidInput where the grid has operations that are not made for ranks
template <class Real>
void require_drawn_on_ranks(const Hierarchy<Real>& grid);

/// Refuses surfaces that are not made for ranks.
/// \param own_gradients whether the field has gradients
///
/// \throw InvalidInput
void require_drawn_on_ranks(const Criterion& criterion, const Bounds& bounds,
                            const IsosurfaceOptions& options, bool own_gradients);

/// A criterion as settle() compares it.
std::string name_of(const Criterion& criterion);
/// The options of a surface as settle() compares them.
template <class Real>
std::string asked_for(std::span<const Level<Real>> levels, const Criterion& criterion,
                      const IsosurfaceOptions& options);

}  // namespace nestgrid::engine
