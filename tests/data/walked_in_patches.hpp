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

/// Values at nodes of a grid with known bisections, as those that vertices carry.
template <class Grid, class Field>
class KnownCarriedValues final : public CarriedValues<Grid> {
public:
    explicit KnownCarriedValues(const Field& field) : field_{&field} {}

    void values_at(std::span<const typename Grid::Node> nodes, std::span<const NodeKey> keys,
                   std::span<double> out) const override {
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = static_cast<double>(field_->template value_at<false>(nodes[i], keys[i]));
        }
    }

private:
    const Field* field_;
};

/// Walks them for a function of position (Hierarchy::bisect_means).
template <class Grid, class Field>
    requires(
        KnowsBisections<Grid, Field>&& HasMaubachPatches<Grid>&& detail::components_of<Field>() ==
            1 &&
        Grid::dimension == 3)
void bisect_patches_of_means(const Grid& grid, const Field& field, const ElementOf<Grid>& e,
                             const double* values, double tolerance, int level, int orientation,
                             detail::ErasedBisectionVisitor<3, double>& visitor) {
    const KnownCarriedValues<Grid, Field> carried(field);
    detail::walk_for(visitor, grid, MeanValues<Grid>(tolerance, carried), e, values, level,
                     orientation);
}

}  // namespace nestgrid
