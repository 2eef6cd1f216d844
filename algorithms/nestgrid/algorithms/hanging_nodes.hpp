// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The hanging nodes of a grid whose adapter does not know them.
#pragma once

#include <nestgrid/detail/erase.hpp>
#include <nestgrid/detail/hanging.hpp>

namespace nestgrid {

/// Walks the whole hierarchy twice, and once more where a rule divides a quadrilateral face in one
/// direction first. Costs O(nodes) memory while it runs.
/// \throw GridError where nodes hang on others than their parents, which the grid does not give:
/// two
///        sides of a face divide it in different directions first, and one of them then across; or
///        where a node hangs on two edges in two directions
HangingNodes derive_hanging_nodes(const Hierarchy<float>& hierarchy);

template <class Grid>
    requires(!std::derived_from<Grid, Hierarchy<float>>)
HangingNodes derive_hanging_nodes(const Grid& grid) {
    const ZeroField<Grid> zero;
    const auto hierarchy = erase(grid, zero);
    return derive_hanging_nodes(static_cast<const Hierarchy<float>&>(hierarchy));
}

}  // namespace nestgrid
