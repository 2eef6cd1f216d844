// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of a field over a two-dimensional hierarchy (paper, sections 2, 3 and 5.2): the
// triangulation of shading.hpp, which says what holds of it, lifted along z by a scale times
// component 0.
#pragma once

#include <nestgrid/algorithms/shading.hpp>

namespace nestgrid {

/// Draws the height field under the projection with `criterion`.
/// \throw InvalidInput, GridError as shading(); InvalidInput also where the scale is not finite
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                     const Bounds& bounds, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});
/// Draws the height field with S from options.threshold.
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const HierarchicalIndicator& indicator, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});
/// Draws the height field with S from options.threshold, after its own preroll.
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});

// Each also takes a grid and a field in the place of the hierarchy.

template <class Grid, class Field>
    requires NodalField<Field, Grid> Shading
    height_field(const Grid& grid, const Field& field, double scale, const Criterion& criterion,
                 const Bounds& bounds, const ShadingOptions& options = {},
                 const Executor& executor = SequentialExecutor{}) {
        return height_field(erase(grid, field), scale, criterion, bounds, options, executor);
    }
template <class Grid, class Field>
    requires NodalField<Field, Grid> Shading height_field(
        const Grid& grid, const Field& field, double scale, const HierarchicalIndicator& indicator,
        const ShadingOptions& options = {}, const Executor& executor = SequentialExecutor{}) {
        return height_field(erase(grid, field), scale, indicator, options, executor);
    }
template <class Grid, class Field>
    requires NodalField<Field, Grid> Shading height_field(
        const Grid& grid, const Field& field, double scale, const ShadingOptions& options = {},
        const Executor& executor = SequentialExecutor{}) {
        return height_field(erase(grid, field), scale, options, executor);
    }

}  // namespace nestgrid
