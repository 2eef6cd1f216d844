// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lets hierarchies of all grids with known bisections walk in patches. Include it before a
// hierarchy is made.
#pragma once

#include <nestgrid/hierarchy.hpp>
#include <patches/erased_bisections.hpp>

namespace nestgrid_test {

/// What a grid has in the place of what is not to be known of it.
struct Nothing {};

/// A grid of whose bisections nothing is known at compile time any more.
template <class Grid>
struct UnknownGrid : Grid {
    using Grid::Grid;
    static constexpr Nothing bisections{};
};

}  // namespace nestgrid_test

namespace nestgrid {

/// Whether the bisections of a grid and a field can be walked in patches (Hierarchy::bisect).
template <class Grid, class Field>
    requires(engine::KnowsBisections<Grid, Field>&& engine::HasMaubachPatches<Grid>&&
                     detail::components_of<Field>() == 1 &&
             detail::fits_handle<ElementOf<Grid>>)
bool knows_patches(const Grid&, const Field&, const HierarchyFacts&) { return true; }

/// Walks the bisections below an element in patches.
template <class Grid, class Field>
    requires(engine::KnowsBisections<Grid, Field>&& engine::HasMaubachPatches<Grid>&&
                 detail::components_of<Field>() == 1)
void bisect_patches(const Grid& grid, const Field& field, const ElementOf<Grid>& e,
                    detail::PatchVisitor& visitor) {
    engine::bisect_for(visitor, grid, field, e);
}

}  // namespace nestgrid
