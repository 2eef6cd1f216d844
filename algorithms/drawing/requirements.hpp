// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every drawing under a criterion requires of the grid, the criterion and the bounds, and what
// it may rely on.
#pragma once

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
void require_same_epoch(const Hierarchy<Real>& hierarchy, const Bounds& bounds);

/// \throw GridError where the grid has changed since the bounds, or what the criterion asks, were
///        computed
/// \throw InvalidInput where the criterion is not saturated on the grid of the bounds, and does not
///        insist, or insists on a field that is decoded on the way down
template <class Real>
void require_sound(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                   const Bounds& bounds);

/// Whether elements may stop without conforming to their neighbours.
template <class Real>
bool may_stop_apart(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                    const Bounds& bounds);

}  // namespace nestgrid::engine
