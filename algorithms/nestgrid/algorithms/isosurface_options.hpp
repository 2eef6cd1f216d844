// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an extraction is asked for, and what is known beside the surface.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/keys.hpp>

namespace nestgrid {

class Indicator;

/// How many elements a traversal met.
struct TraversalCounts {
    std::uint64_t calls = 0;      ///< calls of Inspect(): elements looked at
    std::uint64_t visited = 0;    ///< elements that passed the test of interest
    std::uint64_t extracted = 0;  ///< elements that contribute to the surface
    std::uint64_t limited = 0;    ///< of these: kept from being divided by a limit (high_order.hpp)
};

/// How far what is drawn may be from the data, in the units of the data. Every result has it.
struct ErrorBounds {
    /// What is drawn differs from the data, interpolated on the finest grid, by at most this; never
    /// more than range_bound.
    double error_bound = 0;
    /// What the least and the greatest value of the data alone promise, of any drawing whatever.
    /// Infinity where these values are not known.
    double range_bound = 0;

    /// Whether error_bound promises no more than any drawing keeps, so that it is not worth
    /// printing.
    bool bound_says_nothing() const { return error_bound > 0 && error_bound >= range_bound; }
    /// Makes these the bounds of a drawing that has a part with other bounds.
    void add_bounds(const ErrorBounds& part) {
        error_bound = std::max(error_bound, part.error_bound);
        range_bound = std::max(range_bound, part.range_bound);
    }
};

/// Where a level set cuts an edge of an element.
enum class Cuts : std::uint8_t {
    /// Where P_S U passes through the level: linearly between the ends of the edge. On tetrahedra
    /// the threshold on deviations (indicator.hpp) is then the error.
    linear,
    /// Where U does: the edge is halved at its nodes, as long as there are any, and the half whose
    /// ends differ is kept; the last piece is cut linearly. At equal numbers of triangles the
    /// distance to the true surface is 0.3 to 0.7 of that of linear cuts (root mean square), while
    /// `error_bound` grows by how far P_S U is from the level at the vertices.
    finest,
};

/// How isosurfaces and slices are drawn, and what is kept of them. How finely, a Projection says.
struct IsosurfaceOptions {
    /// Linear without regard to this: edges of elements that may stop beside finer ones (octrees,
    /// red-green refinement, hanging nodes), slices, and surfaces with vertices at nodes.
    Cuts cuts = Cuts::linear;
    /// Unit normals from gradients: the field's own where it offers them, else the mean of the
    /// gradients of the extracted elements around a node, weighted by volume.
    bool normals = false;
    /// Close the surface along the boundary of the domain and of what is hidden, around U >= C.
    bool cap = false;
    /// Keep the extracted elements and which triangle comes from which.
    bool elements = true;
    /// Keep where the corners of each triangle lie in its element, in reference coordinates; not a
    /// number for the few that fill a gap in a face between two directions of refinement.
    bool reference = false;
    /// Put vertices at nodes where U = C there, in the place of slivers around the node, as far as
    /// the surface stays a manifold. Needs memory of the order of the surface; not for streams of
    /// triangles, nor together with `reference`.
    bool at_nodes = false;
    /// Compute every shared vertex again from every element and throw a GridError where one bit
    /// differs: finds keys and positions that do not belong together.
    bool verify = false;
    /// The position_bounds() of the grid (geometry_indicator.hpp), borrowed, to be told how far off
    /// vertices are; or null. On grids with true positions, slices visit all elements without them.
    const Indicator* position_bounds = nullptr;
    /// Called now and then with the counts so far; returning false ends the traversal.
    std::function<bool(const TraversalCounts&)> progress{};
};

/// On every triangle U differs from C by at most error_bound, U being the data interpolated on the
/// finest grid: what S projected away, and in shapes other than simplices what the flatness of the
/// triangles adds. Exact as far as triangles lie in their elements, which curved faces of deformed
/// elements do not quite allow. The range_bound is the greatest |U - C| anywhere; the error bound
/// is no less under a criterion that is not saturated.
template <int dimension>
struct Isosurface : ErrorBounds {
    Surface<dimension> surface;
    TraversalCounts counts;
    /// Every vertex is at most this far from the true position of its point, in units of length, on
    /// a grid with true positions (curved elements). 0 where options.position_bounds is null;
    /// infinity under a criterion that is not saturated. On curved leaves (high_order.hpp) it needs
    /// no position_bounds and holds at every point of every triangle.
    double position_bound = 0;
    /// The error there and back that cut_deviations() promise (cut_indicator.hpp), where a
    /// threshold on them was the criterion: |U - C| on the triangles, |P_S U - C| on the whole
    /// surface U = C, and |U - C| wherever inside and outside are not those of U; all at most this.
    /// It is no less than what the flatness of triangles in leaves makes it, in shapes other than
    /// simplices. Infinity under other criteria, but for none (Exact), and for cuts that lie off
    /// the level of P_S U (Cuts::finest).
    double surface_error = std::numeric_limits<double>::infinity();
    /// On ranks, where no sink takes the surface: two nodes for each vertex, which name it on all
    /// ranks (join_pieces.hpp).
    std::vector<std::array<NodeKey, 2>> names{};
    bool cancelled = false;       ///< by options.progress; the surface is then a part
    std::size_t table_bytes = 0;  ///< hash tables used while extracting
    std::size_t stack_bytes = 0;  ///< depth of the traversal times the size of one state
};

namespace detail {

/// The dimension of a grid with isosurfaces.
template <class Grid>
constexpr int surface_dimension() {
    static_assert(Grid::dimension >= 2, "isosurfaces need a grid of dimension 2 or 3");
    return Grid::dimension;
}

}  // namespace detail

}  // namespace nestgrid
