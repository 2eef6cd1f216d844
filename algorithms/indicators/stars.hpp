// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The preroll by rows of nodes, on grids that know their stars (StarRow). Entries and facts have
// the bits that Sweeps gives.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid::engine {

/// Fills the dense entries. Requires facts().knows_stars.
/// \throw InvalidInput where a value is not usable
template <class Real>
detail::PrerollFacts sweep_stars(const Hierarchy<Real>& hierarchy,
                                 detail::IndicatorEntries& entries);

}  // namespace nestgrid::engine
