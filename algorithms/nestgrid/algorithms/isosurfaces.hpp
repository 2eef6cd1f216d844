// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several isosurfaces in one traversal, and isosurfaces into sinks. What holds of each surface,
// isosurface.hpp says.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/detail/surface_targets.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

namespace detail {

/// Draws isosurfaces of a hierarchy of the same dimension. Defined for dimensions 2 and 3, float
/// and double.
template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
    const SurfaceTargets<dimension>& targets, const Criterion& criterion, const Bounds& bounds,
    const IsosurfaceOptions& options, const Executor& executor);

}  // namespace detail

/// The isosurfaces U = isovalues[i] of component 0 of the field under the projection with
/// `criterion`, in one traversal.
/// \param bounds of the same grid and field, for the search: a HierarchicalIndicator, or other
///        Bounds
/// \param executor of several threads, or of one (executor.hpp); the result does not depend on it
/// \return one result for each isovalue
/// \throw GridError where the field has no value, or where the grid has changed since the bounds
///        were computed
/// \throw InvalidInput where an isovalue is not a number, or a hierarchy has another dimension
template <int dimension, class Real>
std::vector<Isosurface<dimension>> isosurfaces(const Hierarchy<Real>& hierarchy,
                                               std::span<const double> isovalues,
                                               const Criterion& criterion, const Bounds& bounds,
                                               const IsosurfaceOptions& options = {},
                                               const Executor& executor = SequentialExecutor{}) {
    hierarchy.facts().require_dimension(dimension);
    return detail::draw_isosurfaces<dimension>(hierarchy, isovalues, {}, criterion, bounds, options,
                                               executor);
}
template <class Grid, class Field>
auto isosurfaces(const Grid& grid, const Field& field, std::span<const double> isovalues,
                 const Criterion& criterion, const Bounds& bounds,
                 const IsosurfaceOptions& options = {},
                 const Executor& executor = SequentialExecutor{}) {
    return isosurfaces<detail::surface_dimension<Grid>()>(erase(grid, field), isovalues, criterion,
                                                          bounds, options, executor);
}

/// Draws the isosurfaces into sinks (surface.hpp), a MeshSink or a SimplexSink of the grid's
/// dimension for each. The surfaces of the results stay empty.
/// \throw InvalidInput also where there is not one sink for each isovalue, and for normals into a
///        SimplexSink
template <int dimension, class Real, class Sink>
std::vector<Isosurface<dimension>> extract_isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues, std::vector<Sink> sinks,
    const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options = {},
    const Executor& executor = SequentialExecutor{}) {
    hierarchy.facts().require_dimension(dimension);
    return detail::draw_isosurfaces<dimension>(hierarchy, isovalues,
                                               detail::targets_of<dimension>(sinks), criterion,
                                               bounds, options, executor);
}
template <class Grid, class Field, class Sink>
auto extract_isosurfaces(const Grid& grid, const Field& field, std::span<const double> isovalues,
                         std::vector<Sink> sinks, const Criterion& criterion, const Bounds& bounds,
                         const IsosurfaceOptions& options = {},
                         const Executor& executor = SequentialExecutor{}) {
    return extract_isosurfaces<detail::surface_dimension<Grid>()>(
        erase(grid, field), isovalues, std::move(sinks), criterion, bounds, options, executor);
}

}  // namespace nestgrid
