// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several slices and isosurfaces of a hierarchy of dimension 3 in one traversal, under one
// criterion. What holds of each slice, slice.hpp says.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

/// What one walk draws.
struct SliceRequest {
    std::vector<const LevelFunction*> functions;  ///< borrowed
    std::vector<double> isovalues{};              ///< isosurfaces of component 0, behind the slices
};

namespace detail {

/// Defined for float and double.
template <class Real>
std::vector<Slice> draw_slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                               const SurfaceTargets<3>& targets, const Criterion& criterion,
                               const Bounds& bounds, IsosurfaceOptions options,
                               const Executor& executor);

}  // namespace detail

/// Slices and isosurfaces under the projection with `criterion`. All carry all components of the
/// field as attributes.
/// \param bounds and options as of slice()
/// \throw InvalidInput, GridError as slice(); InvalidInput also where an isovalue is not finite
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

/// How many triangles slices() would draw of all of them together, before vertices are merged at
/// nodes, or nothing where there are more than `most` or options.progress ends it. Counts up to
/// there, and stores no triangle.
/// \param options only cap and progress have an effect
/// \throw InvalidInput, GridError as slices()
template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const SliceRequest& request,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most,
                                             const IsosurfaceOptions& options = {},
                                             const Executor& executor = SequentialExecutor{});

/// Draws the slices and isosurfaces into sinks (surface.hpp), one for each. A SimplexSink also gets
/// triangles without area, around nodes that lie on a slice.
/// \throw InvalidInput also where there is not one sink for each, and for normals into a
/// SimplexSink
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
