// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data that jump between elements, drawn with their jumps: finite volumes, discontinuous Galerkin
// methods, data in cells.
//
// Every element is drawn alone, and no two share a vertex. At threshold 0 colours jump as the data
// do; where elements stop, they jump by up to two thresholds more. Planes still take each point of
// the domain once where faces are plane, whatever the levels of elements. Curved slices and height
// fields gape where levels, or the data, change: no surface here is closed.
//
// Where the drawn function must be continuous, make a nodal field first (cell_data.hpp).
#pragma once

#include <functional>
#include <limits>

#include <nestgrid/algorithms/element_deviations.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/level_function.hpp>

namespace nestgrid {

/// How finely data that jump are drawn.
struct DiscontinuousOptions {
    /// Elements stop where component 0 deviates by this at most, in the units of the data.
    double threshold = 0;
    /// Or the least threshold at which there are at most so many triangles; 0 for `threshold`.
    std::uint64_t max_triangles = 0;
    /// Deviations of these data, borrowed; or null: the drawing computes them where elements may
    /// stop.
    const ElementDeviations* deviations = nullptr;
    /// Quadrilaterals in which some component differs by more than this from two triangles get a
    /// vertex in their middle. At least 0, in the units of the data.
    double flatness = std::numeric_limits<double>::infinity();
    /// Keep the drawn elements and which triangle comes from which.
    bool elements = true;
    /// As in IsosurfaceOptions, for slices of grids with true positions.
    const Indicator* position_bounds = nullptr;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

/// Elements that were drawn alone. Component 0, as it is drawn in an element, differs by at most
/// error_bound from the data of the leaves below it: exact where these divide the element as its
/// interpolation does. The range_bound is the range of component 0 where deviations were measured.
struct DiscontinuousSurface : ErrorBounds {
    /// Component k of the data at vertex v is attributes[v * components + k]. The boundary holds
    /// the edges on the boundary of the domain, of shadings only.
    Surface<3> surface;
    TraversalCounts counts;
    TriangleBudget search{};  ///< how the threshold was found, where there is a number of triangles
    bool cancelled = false;   ///< by options.progress; the surface is then a part
};

// All of these throw InvalidInput where the threshold or the flatness is negative or not a number,
// where both a threshold and a number of triangles are given or even the coarsest elements have
// more, where the grid has another dimension, and where a value is not finite; GridError where the
// grid has changed since the deviations were computed. Values of leaves are asked by all threads of
// the executor; no bit of the surface depends on their number.

/// Draws the elements of a two-dimensional grid, coloured by the data.
DiscontinuousSurface shading(const DiscontinuousData& data,
                             const DiscontinuousOptions& options = {},
                             const Executor& executor = SequentialExecutor{});

/// Draws a shading lifted along z by scale times component 0.
/// \throw InvalidInput also where the scale is not finite
DiscontinuousSurface height_field(const DiscontinuousData& data, double scale,
                                  const DiscontinuousOptions& options = {},
                                  const Executor& executor = SequentialExecutor{});

/// Draws the slice of a three-dimensional grid by the zero of a function of position, oriented
/// towards where the function is negative. Where it runs in a face between two elements, the one
/// in which the function is negative colours it.
/// \throw InvalidInput also where the function has no finite value
DiscontinuousSurface slice(const DiscontinuousData& data, const LevelFunction& function,
                           const DiscontinuousOptions& options = {},
                           const Executor& executor = SequentialExecutor{});

}  // namespace nestgrid
