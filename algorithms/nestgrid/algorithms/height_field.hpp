// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The adaptive grid of a two-dimensional hierarchy as a conforming triangulation that carries the
// field (paper, sections 2, 3 and 5.2): shaded in the plane or on a surface in space, or lifted to
// the graph of the field.
//
// Invariants, with a saturated criterion:
//   - nodes of a finer side are vertices of the coarser element, with values linear along its edge;
//   - a vertex is named by the key of its node, or lies inside one element;
//   - the diagonal of a quadrilateral is chosen by the positions and values of its corners.
// Consequence: every inner edge belongs to two triangles, the drawn function is continuous, and
// nothing depends on numbers of nodes or on threads.
#pragma once

#include <limits>
#include <optional>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

struct ShadingOptions {
    /// epsilon, in the units of the data: offsets up to it are projected away. At least 0.
    double threshold = 0;
    /// Quadrilaterals in which some component differs by more than this from two triangles get a
    /// vertex in their middle. At least 0, in the units of the data.
    double flatness = std::numeric_limits<double>::infinity();
    /// Keep the extracted elements and which triangle comes from which.
    bool elements = true;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

struct Shading {
    /// Component k of the field at vertex v is attributes[v * components + k]. The triangles are
    /// oriented as the elements: counterclockwise in the plane.
    Surface<3> surface;
    TraversalCounts counts;
    /// Component 0, drawn linearly on triangles, differs by at most this from the data interpolated
    /// on the finest grid. Infinity under a criterion that is not saturated.
    double error_bound = 0;
    bool cancelled = false;            ///< by options.progress; the surface is then a part
    std::size_t edge_nodes = 0;        ///< nodes of finer sides that were recorded
    std::size_t edge_nodes_bytes = 0;  ///< memory of this record
    std::size_t table_bytes = 0;       ///< hash table of the vertices
};

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

/// Draws a shading lifted along z by scale times component 0.
/// \throw InvalidInput also where the scale is not finite
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                     const Bounds& bounds, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const HierarchicalIndicator& indicator, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});
template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{});

/// The number of triangles that a shading, or a height field of any scale, has under a criterion,
/// or nothing where there are more than `most`. Counts up to there, and stores no triangle.
/// \param options only flatness and progress have an effect
/// \throw InvalidInput, GridError as shading()
template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options = {},
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
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading height_field(const Grid& grid, const Field& field, double scale, const Criterion& criterion,
                     const Bounds& bounds, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{}) {
    return height_field(erase(grid, field), scale, criterion, bounds, options, executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading height_field(const Grid& grid, const Field& field, double scale,
                     const HierarchicalIndicator& indicator, const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{}) {
    return height_field(erase(grid, field), scale, indicator, options, executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
Shading height_field(const Grid& grid, const Field& field, double scale,
                     const ShadingOptions& options = {},
                     const Executor& executor = SequentialExecutor{}) {
    return height_field(erase(grid, field), scale, options, executor);
}
template <class Grid, class Field>
    requires(!detail::AnyHierarchy<Grid>)
std::optional<std::uint64_t> count_triangles(const Grid& grid, const Field& field,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options = {},
                                             const Executor& executor = SequentialExecutor{}) {
    return count_triangles(erase(grid, field), criterion, bounds, most, options, executor);
}

}  // namespace nestgrid
