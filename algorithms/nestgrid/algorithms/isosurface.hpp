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
// (table.hpp), with its dimension: isosurface<3>(hierarchy, isovalue).
#pragma once

#include <utility>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

namespace detail {

/// Where the surfaces go: one sink for each isovalue, or none, for surfaces in the results.
template <int dimension>
struct SurfaceTargets {
    std::vector<MeshSink<dimension>*> meshes;
    std::vector<SimplexSink<dimension>*> soups;
};

/// \tparam Sink a MeshSink or a SimplexSink
template <int dimension, class Sink>
SurfaceTargets<dimension> targets_of(std::vector<Sink>& sinks) {
    SurfaceTargets<dimension> targets;
    for (Sink& sink : sinks) {
        if constexpr (std::is_convertible_v<Sink*, MeshSink<dimension>*>) {
            targets.meshes.push_back(&sink);
        } else {
            targets.soups.push_back(&sink);
        }
    }
    return targets;
}

/// Draws isosurfaces of a hierarchy of the same dimension. Defined for dimensions 2 and 3, float
/// and double.
template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
    const SurfaceTargets<dimension>& targets, const Criterion& criterion, const Bounds& bounds,
    const IsosurfaceOptions& options, const Executor& executor);

/// S from options.threshold or options.max_triangles.
template <int dimension, class Real>
Threshold criterion_for(const Hierarchy<Real>& hierarchy, double isovalue,
                        const HierarchicalIndicator& indicator, const IsosurfaceOptions& options,
                        const Executor& executor);

template <class Grid>
constexpr int surface_dimension() {
    static_assert(Grid::dimension >= 2, "isosurfaces need a grid of dimension 2 or 3");
    return Grid::dimension;
}

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
    return detail::draw_isosurfaces<dimension>(hierarchy, isovalues,
                                               detail::SurfaceTargets<dimension>{}, criterion,
                                               bounds, options, executor);
}
template <class Grid, class Field>
auto isosurfaces(const Grid& grid, const Field& field, std::span<const double> isovalues,
                 const Criterion& criterion, const Bounds& bounds,
                 const IsosurfaceOptions& options = {},
                 const Executor& executor = SequentialExecutor{}) {
    return isosurfaces<detail::surface_dimension<Grid>()>(erase(grid, field), isovalues, criterion,
                                                          bounds, options, executor);
}

/// The same, each surface into a sink of its own (surface.hpp); those of the results stay empty.
/// \tparam Sink a MeshSink or a SimplexSink of the grid's dimension
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

/// One isosurface.
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const Criterion& criterion, const Bounds& bounds,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{}) {
    return std::move(isosurfaces<dimension>(hierarchy, std::span<const double>(&isovalue, 1),
                                            criterion, bounds, options, executor)
                         .front());
}
template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue, const Criterion& criterion,
                const Bounds& bounds, const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, criterion,
                                                         bounds, options, executor);
}

/// The same with S from options.threshold or options.max_triangles.
/// \throw InvalidInput also where the threshold is negative or not a number, and where even the
///        coarsest surface has more triangles than asked for
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const HierarchicalIndicator& indicator,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{}) {
    hierarchy.facts().require_dimension(dimension);
    const Threshold criterion =
        detail::criterion_for<dimension>(hierarchy, isovalue, indicator, options, executor);
    return isosurface<dimension>(hierarchy, isovalue, criterion, indicator, options, executor);
}
template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue,
                const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, indicator,
                                                         options, executor);
}

/// The same with its own preroll: one call for one surface.
template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const IsosurfaceOptions& options = {},
                                 const Executor& executor = SequentialExecutor{}) {
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return isosurface<dimension>(hierarchy, isovalue, indicator, options, executor);
}
template <class Grid, class Field>
auto isosurface(const Grid& grid, const Field& field, double isovalue,
                const IsosurfaceOptions& options = {},
                const Executor& executor = SequentialExecutor{}) {
    return isosurface<detail::surface_dimension<Grid>()>(erase(grid, field), isovalue, options,
                                                         executor);
}

}  // namespace nestgrid
