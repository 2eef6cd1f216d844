// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The adaptive grid of a two-dimensional hierarchy as a conforming triangulation that carries the
// field, in the plane or on a surface in space (paper, sections 2, 3 and 5.2).
//
// Invariants, with a saturated criterion:
//   - nodes of a finer side are vertices of the coarser element, with values linear along its edge;
//   - a vertex is named by the key of its node, or lies inside one element;
//   - the diagonal of a quadrilateral is chosen by the positions and values of its corners.
// Consequence: every inner edge belongs to two triangles, the drawn function is continuous, and
// nothing depends on numbers of nodes or on threads.
#pragma once

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/shading_options.hpp>

namespace nestgrid {

/// Draws the elements at which `criterion` stops, with all components of the field as attributes.
/// \param bounds of the same grid and field: a HierarchicalIndicator, or other Bounds
/// \param executor of several threads, or of one; the result does not depend on it
/// \throw InvalidInput where the hierarchy is not two-dimensional, the criterion is not saturated,
///        or options.flatness is negative or not a number
/// \throw GridError where the field has no value, or where the grid has changed since the bounds
///        were computed
template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const Criterion& criterion, const Bounds& bounds,
                const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{});
/// Draws a shading with S from options.threshold.
/// \throw InvalidInput also where the threshold is negative or not a number
template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{});
/// Draws a shading with S from options.threshold, after its own preroll.
template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{});

// Each also takes a grid and a field in the place of the hierarchy.

template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading shading(const Grid& grid, const Field& field, const Criterion& criterion,
                const Bounds& bounds, const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return shading(erase(grid, field), criterion, bounds, options, executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading shading(const Grid& grid, const Field& field, const HierarchicalIndicator& indicator,
                const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return shading(erase(grid, field), indicator, options, executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading shading(const Grid& grid, const Field& field, const ShadingOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return shading(erase(grid, field), options, executor);
}

}  // namespace nestgrid
