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
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/isosurface_visitor.hpp>

namespace nestgrid {

namespace detail {

template <class Grid, class Indicator>
void require_drawable(const Grid& grid, std::span<const double> isovalues,
                      const Indicator& indicator) {
    for (const double isovalue : isovalues) {
        if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    }
    if (indicator.epoch() != epoch(grid)) {
        throw GridError("the grid has changed since its indicator was computed");
    }
}

/// \return whether options.progress ended it
template <class Visitor, class Executor>
bool run_visitor(Visitor& visitor, const Executor& executor) {
    try {
        visitor.run(executor);
        return false;
    } catch (const Cancelled&) {
        return true;
    }
}

}  // namespace detail

/// The isosurfaces U = isovalues[i] of component 0 of the field under the projection with
/// `criterion`, in one traversal, each into its own sink (surface.hpp).
/// \param indicator of the same grid and field: its bounds guide the search. HierarchicalIndicator,
///        or any class with its offset_bound(), bound(), hanging() and epoch()
/// \return what is known beside the surfaces, one per isovalue; `surface` stays empty
/// \throw GridError where the field has no value, or where the grid has changed since the indicator
///        was computed
/// \throw InvalidInput where an isovalue is not a number or there is not one sink for each; for
///        normals into a sink without indices
/// \param executor of several threads, or of one (executor.hpp); the result does not depend on it
template <class Grid, class Field, Criterion S, class Indicator, class Sink,
          Executor E = SequentialExecutor>
std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> extract_isosurfaces(
    const Grid& grid, const Field& field, std::span<const double> isovalues,
    std::vector<Sink> sinks, const S& criterion, const Indicator& indicator,
    const IsosurfaceOptions& options = {}, const E& executor = {}) {
    static_assert(Grid::dimension >= 2, "isosurfaces need a grid of dimension 2 or 3");
    detail::require_drawable(grid, isovalues, indicator);
    if (sinks.size() != isovalues.size()) {
        throw InvalidInput(std::to_string(isovalues.size()) +
                           " isovalues need as many sinks, not " + std::to_string(sinks.size()));
    }
    if (!detail::IndexedSink<Sink> && options.normals) {
        throw InvalidInput("a stream of triangles has no normals");
    }
    using Visitor = detail::IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>;
    const typename Visitor::Walk walk(grid, field, indicator.hanging());
    Visitor visitor(walk, isovalues, std::move(sinks), criterion, indicator, options);
    const bool cancelled = detail::run_visitor(visitor, executor);
    std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> results(isovalues.size());
    for (std::size_t i = 0; i < results.size(); ++i) {
        visitor.report(i, results[i]);
        results[i].cancelled = cancelled;
    }
    return results;
}

/// The same as indexed surfaces.
template <class Grid, class Field, Criterion S, class Indicator, Executor E = SequentialExecutor>
std::vector<Isosurface<Grid::dimension, ElementOf<Grid>>> isosurfaces(
    const Grid& grid, const Field& field, std::span<const double> isovalues, const S& criterion,
    const Indicator& indicator, const IsosurfaceOptions& options = {}, const E& executor = {}) {
    using Sink = SurfaceSink<Grid::dimension, ElementOf<Grid>>;
    std::vector<typename Sink::Target> surfaces(isovalues.size());
    std::vector<Sink> sinks;
    for (auto& surface : surfaces) sinks.emplace_back(surface, options.elements);
    auto results = extract_isosurfaces(grid, field, isovalues, std::move(sinks), criterion,
                                       indicator, options, executor);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].surface = std::move(surfaces[i]);
    return results;
}

/// One isosurface.
template <class Grid, class Field, Criterion S, class Indicator, Executor E = SequentialExecutor>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const S& criterion,
                                                        const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {}) {
    return std::move(isosurfaces(grid, field, std::span<const double>(&isovalue, 1), criterion,
                                 indicator, options, executor)
                         .front());
}

/// The same with S from options.threshold or options.max_triangles.
/// \throw InvalidInput also where the threshold is negative or not a number, and where even the
///        coarsest surface has more triangles than asked for
template <class Grid, class Field, class Indicator, Executor E = SequentialExecutor>
    requires requires(const Indicator& i) { i.stop(NodeKey{}); }
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const Indicator& indicator,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {});

/// The same with its own preroll: one call for one surface.
template <class Grid, class Field, Executor E = SequentialExecutor>
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue,
                                                        const IsosurfaceOptions& options = {},
                                                        const E& executor = {}) {
    const HierarchicalIndicator indicator(grid, field, executor);
    return isosurface(grid, field, isovalue, indicator, options, executor);
}

}  // namespace nestgrid

#include <nestgrid/algorithms/triangle_budget.hpp>
