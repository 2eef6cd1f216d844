// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A slice of a hierarchy of dimension 3: the zero of a function of position, coloured by the data
// (paper, sections 2, 3 and 5.2). Geometry decides where the slice runs, the data decide how fine
// it is, and only elements that the function may pass through are visited. Several slices and
// isosurfaces share one traversal in slices.hpp.
//
// Invariants:
//   - a plane that runs through nodes, edges or faces has its vertices there, and takes each point
//     once; where nodes lie means of others, vertices are on the plane up to rounding;
//   - colours are the values of P_S U at vertices and linear on triangles: continuous across all
//     changes of level and shape.
// Where a grid gives true positions of new nodes, options.position_bounds tell which elements the
// function may pass through; without them all are visited.
// On a curved slice, elements stop where the data allow it: combine the criterion with DeepestLevel
// or NodeLevels to follow the function more closely.
#pragma once

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/level_function.hpp>

namespace nestgrid {

/// Attribute c of a vertex is component c of the field. The error bound is that of the colour of
/// component 0: on every triangle it differs by at most this from U, at the same place.
using Slice = Isosurface<3>;

/// The slice under the projection with `criterion`.
/// \param bounds of the same grid and field
/// \param options vertices are put at nodes in any case
/// \throw InvalidInput where the hierarchy has another dimension, or a function has no finite value
/// \throw GridError as isosurface()
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{});
/// Draws the slice with S from options.threshold or options.max_triangles.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{});
/// Draws the slice like that after a preroll of its own. At threshold 0, and without a budget, it
/// needs none.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const IsosurfaceOptions& options = {}, const Executor& executor = SequentialExecutor{});

// Each also takes a grid and a field in the place of the hierarchy.

template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, criterion, bounds, options, executor);
}
template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, indicator, options, executor);
}
template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, options, executor);
}

}  // namespace nestgrid
