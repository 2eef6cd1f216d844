// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines of two-dimensional grids as joined lines (paper, sections 3 and 8). Those on surfaces
// are in surface_isolines.hpp, which this header includes.
#pragma once

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>

namespace nestgrid {

/// Isolines of a two-dimensional grid. On every line U differs from its value by at most
/// error_bound; the range_bound is the greatest difference anywhere from any of the values.
struct Isolines : ErrorBounds {
    Polylines lines;
    TraversalCounts counts;  ///< elements are counted as extracted once for each value
    bool cancelled = false;  ///< by options.progress; the lines are then a part
};

/// The isolines of component 0 of a field under the projection with `criterion`, in one traversal.
/// They end on the boundary of the domain only. Vertices carry components 1 ... of the field.
/// \param options as of isosurface(); normals, elements and references are not kept
/// \throw GridError, InvalidInput as isosurface()
template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const Criterion& criterion, const Bounds& bounds,
                  const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{});
/// Draws isolines with S from options.threshold.
/// \throw InvalidInput also for options.max_triangles, which is for one isoline
template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{});
/// Draws isolines with S from options.threshold, after its own preroll.
template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{});

// Each also takes a grid and a field in the place of the hierarchy.

template <class Grid, class Field>
    requires(Grid::dimension == 2)
Isolines isolines(const Grid& grid, const Field& field, std::span<const double> values,
                  const Criterion& criterion, const Bounds& bounds,
                  const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{}) {
    return isolines(erase(grid, field), values, criterion, bounds, options, executor);
}
template <class Grid, class Field>
    requires(Grid::dimension == 2)
Isolines isolines(const Grid& grid, const Field& field, std::span<const double> values,
                  const HierarchicalIndicator& indicator, const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{}) {
    return isolines(erase(grid, field), values, indicator, options, executor);
}
template <class Grid, class Field>
    requires(Grid::dimension == 2)
Isolines isolines(const Grid& grid, const Field& field, std::span<const double> values,
                  const IsosurfaceOptions& options = {},
                  const Executor& executor = SequentialExecutor{}) {
    return isolines(erase(grid, field), values, options, executor);
}

}  // namespace nestgrid
