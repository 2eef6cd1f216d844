// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same error: edges of a drawn isosurface are collapsed as long as the data
// allow it.
//
// Invariants, checked for every collapse against the field and not against a mesh:
//   - on every new triangle |U - C| <= e, U being the data interpolated on the finest grid;
//   - no part of the domain in which |U - C| > e changes its side;
//   - the triangles around the edge stay a manifold, turn and flatten by no more than is allowed,
//     and nothing else meets the tetrahedra that they sweep;
//   - a vertex on the border of the surface stays on the planes of the domain's boundary.
// Consequence: a surface that is closed, but for its border, that crosses itself nowhere, and on
// which |U - C| <= e, stays such a surface. Where U > C + e is inside, and U < C - e outside.
// The result depends neither on the order nor on the number of threads.
#pragma once

#include <algorithm>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// What a collapse is asked for.
struct CollapseOptions {
    double error = 0;    ///< e, in the units of the data: positive
    double turn = 78;    ///< the greatest turn of a triangle in one collapse, in degrees, below 90
    double shape = 0.1;  ///< the least quality of a triangle, 1 for an equilateral one and 0 for
                         ///< one without area; worse ones stay where they are, or get better
};

/// What was done, and how far what is drawn may be from the data.
struct Collapsed {
    double error = 0;           ///< |U - C| is at most this on triangles that keep e
    std::size_t exceeding = 0;  ///< triangles that did not keep e from the beginning, and stay
    std::size_t collapses = 0;
    // Edges that were left because of ...
    std::size_t refused_by_manifold = 0;
    std::size_t refused_by_shape = 0;
    std::size_t refused_by_field = 0;     ///< |U - C| would exceed e
    std::size_t refused_by_sides = 0;     ///< a part where |U - C| > e would change its side
    std::size_t refused_by_crossing = 0;  ///< triangles would cross

    /// Makes the bounds of what was drawn those of what is left of it. Triangles that do not keep e
    /// have the bounds that they had.
    void hand_to(ErrorBounds& bounds, double& surface_error) const {
        bounds.error_bound = exceeding == 0 ? error : std::max(error, bounds.error_bound);
        surface_error = exceeding == 0 ? error : std::max(error, surface_error);
    }
};

/// Collapses edges of a surface that isosurface() has drawn, without a cap. Best begun with one of
/// half the error, whose triangles fit the data and are few.
///
/// Afterwards the surface has vertices, triangles and boundary edges, and normals and attributes
/// where it had them: normals from its triangles, attributes of the data at its vertices. What is
/// told of elements is gone. Triangles in elements with bent faces are refused where it cannot be
/// decided that they keep e.
/// \param isovalue C
/// \param bounds of the same grid and field: a HierarchicalIndicator, or other Bounds
/// \throw InvalidInput where an option or the isovalue is out of range, or the hierarchy has
/// another
///        dimension
/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
Collapsed collapse(Surface<3>& surface, const Hierarchy<Real>& hierarchy, double isovalue,
                   const Bounds& bounds, const CollapseOptions& options,
                   const Executor& executor = SequentialExecutor{});
template <class Grid, class Field>
Collapsed collapse(Surface<3>& surface, const Grid& grid, const Field& field, double isovalue,
                   const Bounds& bounds, const CollapseOptions& options,
                   const Executor& executor = SequentialExecutor{}) {
    return collapse(surface, erase(grid, field), isovalue, bounds, options, executor);
}

}  // namespace nestgrid
