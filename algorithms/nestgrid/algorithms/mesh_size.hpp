// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The mesh size of each node, for lenses (paper, section 4.3): the greatest diameter of the
// elements that make the node, spread from finer nodes to coarser ones.
//
// The paper measures h(x) by the distance of x from its parents. That number differs between the
// new nodes of one split, and grows from a node to a finer one where a later edge is longer. The
// diameter of the split element is the same for all of them, and spreading mends the rest.
// Spread by a slope, a size exceeds the diameter by at most slope times the sum of the distances
// from corners to new nodes on all finer levels: elements in a lens are that much finer than asked
// for.
#pragma once

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

namespace nestgrid {

/// Walks the whole hierarchy; no values are asked for.
/// \param spread with the slope, and the factor, of the lenses to come
/// \return lengths, in the units of the grid; infinite at nodes where no element may stop
/// \throw InvalidInput where the factor of the spread is below 1 or its slope below 0
SweptIndicator mesh_size(const FieldOnGrid& field, const Spread& spread);
template <class Grid>
    requires(!std::convertible_to<const Grid&, FieldOnGrid>)
SweptIndicator mesh_size(const Grid& grid, const Spread& spread) {
    return mesh_size(erase(grid, ZeroField<Grid>{}), spread);
}

}  // namespace nestgrid
