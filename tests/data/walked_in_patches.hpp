// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lets hierarchies of all grids with known bisections walk in patches. Include it before a
// hierarchy is made.
#pragma once

#include <nestgrid/hierarchy.hpp>
#include <patches/erased_bisections.hpp>

namespace nestgrid {

/// Whether the bisections of a grid and a field can be walked in patches (Hierarchy::bisect).
template <class Grid, class Field>
    requires(
        KnowsBisections<Grid, Field>&& HasMaubachPatches<Grid>&& detail::components_of<Field>() ==
            1 &&
        detail::fits_handle<ElementOf<Grid>>)
bool knows_patches(const Grid&, const Field&, const HierarchyFacts&) { return true; }

/// Walks the bisections below an element in patches.
template <class Grid, class Field>
    requires(
        KnowsBisections<Grid, Field>&& HasMaubachPatches<Grid>&& detail::components_of<Field>() ==
        1)
void bisect_patches(
    const Grid& grid, const Field& field, Context<Grid>&, const ElementOf<Grid>& e,
    const typename Field::value_type* values, int level, int orientation,
    detail::ErasedBisectionVisitor<Grid::dimension, typename Field::value_type>& visitor) {
    detail::walk_for(visitor, grid, field, e, values, level, orientation);
}

}  // namespace nestgrid
