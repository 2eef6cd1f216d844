// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of a field over a two-dimensional hierarchy (paper, sections 2, 3 and 5.2): the
// triangulation of shading.hpp, which says what holds of it, lifted along z by a scale times
// component 0.
#pragma once

#include <nestgrid/algorithms/shading.hpp>

namespace nestgrid {

/// Draws the height field.
/// \throw InvalidInput, GridError as shading(); InvalidInput also where the scale is not finite
Projected<Shading> height_field(const Prerolls& prerolls, double scale,
                                const Projection& projection = {},
                                const ShadingOptions& options = {}, const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> Projected<Shading> height_field(
        const Grid& grid, const Field& field, double scale, const Projection& projection = {},
        const ShadingOptions& options = {}, const Work& work = {}) {
        return height_field(Prerolls(grid, field), scale, projection, options, work);
    }

}  // namespace nestgrid
