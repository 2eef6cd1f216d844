// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Adaptive isosurfaces (isolines in two dimensions) on any shapes (paper, sections 3, 4.4 and 8).
//
// Invariants:
//   - a node is inside where P_S U >= C; an edge is cut where its ends differ, from its lower to
//     its higher value, at a fraction kept in [2^-20, 1 - 2^-20] of its maximal edge;
//   - a vertex is named by the keys of the two nodes of the maximal edge it cuts;
//   - the contour on a face is a function of the face alone, or what the finer side draws there.
// Consequences, with a saturated criterion: every edge of the surface belongs to two triangles, or
// to one on the boundary of the domain; shared vertices are equal to the last bit; values equal to
// C are no special case, and no triangle degenerates to a point. The proof:
// docs/closed_surfaces.md.
//
// The functions below make a Hierarchy of the grid and the field (detail/erase.hpp) and call the
// compiled library. Each also takes a hierarchy in their place, such as that of a table in C
// (table.hpp), with its dimension: isosurface<3>(hierarchy, isovalue). Several surfaces share one
// traversal in isosurfaces.hpp.
#pragma once

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

/// The isosurface U = isovalue of component 0 of the field under the projection with `criterion`.
/// \param bounds of the same grid and field, for the search: a HierarchicalIndicator, or other
///        Bounds
/// \param executor of several threads, or of one (executor.hpp); the result does not depend on it
/// \throw GridError where the field has no value, or where the grid has changed since the bounds
///        were computed
/// \throw InvalidInput where the isovalue is not a number, or the hierarchy has another dimension
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const Criterion& criterion, const Bounds& bounds,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{});
/// Draws the isosurface with S from options.threshold or options.max_triangles.
/// \throw InvalidInput also where the threshold is negative or not a number, and where even the
///        coarsest surface has more triangles than asked for
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const HierarchicalIndicator& indicator,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{});
/// Draws the isosurface like that after a preroll of its own.
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{});

// Each also takes a grid and a field in the place of the hierarchy.

template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue, const Criterion& criterion,
                const Bounds& bounds, const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, criterion,
                                                         bounds, options, executor);
}
template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue,
                const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, indicator,
                                                         options, executor);
}
template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue,
                const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, options,
                                                         executor);
}

}  // namespace nestgrid
