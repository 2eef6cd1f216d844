// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh size by rows of nodes, on grids that know their stars (StarRow): no split is kept, and a
// walk sees each kind of split once.
//
// The numbers are those of the sweep over all splits, or lower ones that saturate as well, because
// a node hands on by its own distance from a corner and not by the greatest one of the split.
#pragma once

#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid::engine {

/// Requires facts().knows_star_positions.
/// \throw InvalidInput where the factor of the spread is below 1 or its slope below 0
template <class Real>
SweptIndicator star_sizes(const Hierarchy<Real>& hierarchy, const Spread& spread);

}  // namespace nestgrid::engine
