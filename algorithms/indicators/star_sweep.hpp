// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sweep that saturates an indicator (fine_to_coarse.hpp) by rows of nodes, on grids that know
// their stars (StarRow): no split is kept.
//
// The numbers are those of the sweep over all splits, or lower ones that saturate as well, because
// a node hands on by its own distance from a corner and not by the greatest one of the split. Only
// on lattices of less than seven nodes along an axis may they be greater: keys do not tell there in
// which direction a node lies.
#pragma once

#include <cstdint>
#include <vector>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// Requires facts().knows_star_positions.
/// \param etas by key, as bfloat16
template <class Real>
void sweep_rows(const Hierarchy<Real>& hierarchy, const Spread& spread,
                std::vector<std::uint16_t>& etas);

}  // namespace nestgrid::engine
