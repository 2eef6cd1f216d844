// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is asked of a shading or a height field, and what comes out.
#pragma once

#include <functional>
#include <limits>

#include <nestgrid/algorithms/isosurface_options.hpp>

namespace nestgrid {

/// How shadings and height fields are drawn, and what is kept of them. How finely, a Projection
/// says.
struct ShadingOptions {
    /// Quadrilaterals in which some component differs by more than this from two triangles get a
    /// vertex in their middle. At least 0, in the units of the data.
    double flatness = std::numeric_limits<double>::infinity();
    /// Keep the extracted elements and which triangle comes from which.
    bool elements = true;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

/// Component 0, drawn linearly on triangles, differs by at most error_bound from the data
/// interpolated on the finest grid. The range_bound is the range of component 0; the error bound is
/// no less under a criterion that is not saturated.
struct Shading : ErrorBounds {
    /// Component k of the field at vertex v is attributes[v * components + k]. The triangles are
    /// oriented as the elements: counterclockwise in the plane.
    Surface<3> surface;
    TraversalCounts counts;
    bool cancelled = false;  ///< by options.progress; the surface is then a part
    /// On curved leaves (high_order.hpp), how far any point may be from its true place, before it
    /// is lifted; in units of length.
    double position_bound = 0;
    /// Names of vertices on distributed grids, for join_pieces().
    std::vector<std::array<NodeKey, 2>> names{};
    std::size_t edge_nodes = 0;        ///< nodes of finer sides that were recorded
    std::size_t edge_nodes_bytes = 0;  ///< memory of this record
    std::size_t table_bytes = 0;       ///< hash table of the vertices, and what is put aside
};

}  // namespace nestgrid
