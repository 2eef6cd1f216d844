// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of hierarchies of dimension 3: the zero of a function of position, coloured by the data
// (paper, sections 2, 3 and 5.2). Geometry decides where the slice runs, the data decide how fine
// it is, and only elements that the function may pass through are visited.
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

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/level_function.hpp>

namespace nestgrid {

/// Attribute c of a vertex is component c of the field. The error bound is that of the colour of
/// component 0: on every triangle it differs by at most this from U, at the same place.
using Slice = Isosurface<3>;

/// What one walk draws.
struct SliceRequest {
    std::vector<const LevelFunction*> functions;  ///< borrowed
    std::vector<double> isovalues{};              ///< isosurfaces of component 0, behind the slices
};

namespace detail {

/// Draws slices, and isosurfaces behind them.
template <class Real>
std::vector<Slice> draw_slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                               const SurfaceTargets<3>& targets, const Criterion& criterion,
                               const Bounds& bounds, IsosurfaceOptions options,
                               const Executor& executor);
/// A slice with S from options.threshold or options.max_triangles.
/// \param indicator null: computed here, or not needed at threshold 0
template <class Real>
Slice draw_slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                 const HierarchicalIndicator* indicator, const IsosurfaceOptions& options,
                 const Executor& executor);

}  // namespace detail

/// Slices and isosurfaces in one traversal, under the projection with `criterion`. All carry all
/// components of the field as attributes.
/// \param bounds of the same grid and field
/// \param options vertices are put at nodes in any case
/// \throw InvalidInput where the hierarchy has another dimension, or a function has no finite value
/// \throw GridError as isosurfaces()
template <class Real>
std::vector<Slice> slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                          const Criterion& criterion, const Bounds& bounds,
                          const IsosurfaceOptions& options = {},
                          const Executor& executor = SequentialExecutor{}) {
    return detail::draw_slices(hierarchy, request, {}, criterion, bounds, options, executor);
}
template <class Grid, class Field>
std::vector<Slice> slices(const Grid& grid, const Field& field, const SliceRequest& request,
                          const Criterion& criterion, const Bounds& bounds,
                          const IsosurfaceOptions& options = {},
                          const Executor& executor = SequentialExecutor{}) {
    return slices(erase(grid, field), request, criterion, bounds, options, executor);
}

/// One slice.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return std::move(
        slices(hierarchy, {{&function}}, criterion, bounds, options, executor).front());
}
template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, criterion, bounds, options, executor);
}

/// Draws one slice with S from options.threshold or options.max_triangles.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return detail::draw_slice(hierarchy, function, &indicator, options, executor);
}
template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, indicator, options, executor);
}

/// Draws one slice like that, after its own preroll, or, at threshold 0, without any.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return detail::draw_slice(hierarchy, function, nullptr, options, executor);
}
template <class Grid, class Field>
Slice slice(const Grid& grid, const Field& field, const LevelFunction& function,
            const IsosurfaceOptions& options = {},
            const Executor& executor = SequentialExecutor{}) {
    return slice(erase(grid, field), function, options, executor);
}

/// Slices and isosurfaces, each into a sink of its own (surface.hpp). A SimplexSink also gets
/// triangles without area, around nodes that lie on a slice.
template <class Real, class Sink>
std::vector<Slice> extract_slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                                  std::vector<Sink> sinks, const Criterion& criterion,
                                  const Bounds& bounds, const IsosurfaceOptions& options = {},
                                  const Executor& executor = SequentialExecutor{}) {
    return detail::draw_slices(hierarchy, request, detail::targets_of<3>(sinks), criterion, bounds,
                               options, executor);
}
template <class Grid, class Field, class Sink>
std::vector<Slice> extract_slices(const Grid& grid, const Field& field, const SliceRequest& request,
                                  std::vector<Sink> sinks, const Criterion& criterion,
                                  const Bounds& bounds, const IsosurfaceOptions& options = {},
                                  const Executor& executor = SequentialExecutor{}) {
    return extract_slices(erase(grid, field), request, std::move(sinks), criterion, bounds, options,
                          executor);
}

}  // namespace nestgrid
