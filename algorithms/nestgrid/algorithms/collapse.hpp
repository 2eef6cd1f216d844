// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same error, or within the same distance: edges of a drawn isosurface are
// collapsed as long as the data allow it.
//
// Invariants, checked for every collapse:
//   - the triangles around the edge stay a manifold, turn and flatten by no more than is allowed,
//     and nothing else meets the tetrahedra that they sweep;
//   - a vertex on the border of the surface stays on the planes of the domain's boundary;
//   - where an error e is asked for, by the field and not by a mesh: on every new triangle
//     |U - C| <= e, U being the data interpolated on the finest grid, and no part of the domain in
//     which |U - C| > e changes its side;
//   - where a distance is asked for, by the isosurface of all data: no point of a new triangle is
//     farther from that, and no point of that becomes farther from what is drawn.
// Consequence: a surface that is closed, but for its border, that crosses itself nowhere, and that
// keeps what is asked for, stays such a surface. With an error, where U > C + e is inside, and
// where U < C - e outside. With a distance, nothing is lost, however thin.
// The result depends neither on the order nor on the number of threads.
#pragma once

#include <algorithm>
#include <optional>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/nearness.hpp>
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// What a collapse is asked for: an error, a distance or both.
struct CollapseOptions {
    std::optional<double> error{};  ///< e, in the units of the data: positive
    /// The distance there and back; the surface is to keep it from the beginning.
    std::optional<Nearness> nearness{};
    double turn = 78;    ///< the greatest turn of a triangle in one collapse, in degrees, below 90
    double shape = 0.1;  ///< the least quality of a triangle, 1 for an equilateral one and 0 for
                         ///< one without area; worse ones stay where they are, or get better
};

/// What was done, and how far what is drawn may be from the data.
struct Collapsed {
    /// |U - C| is at most this on triangles that keep what is asked for; infinite without an error.
    double error = 0;
    /// Triangles that did not keep it from the beginning, and stay.
    std::size_t exceeding = 0;
    /// Triangles of the isosurface of all data that were farther, in part, from the beginning.
    std::size_t missed = 0;
    std::size_t collapses = 0;
    // Edges that were left because of ...
    std::size_t refused_by_manifold = 0;
    std::size_t refused_by_shape = 0;
    std::size_t refused_by_field = 0;     ///< |U - C| would exceed e
    std::size_t refused_by_sides = 0;     ///< a part where |U - C| > e would change its side
    std::size_t refused_by_distance = 0;  ///< it would be exceeded, or a triangle leave the domain
    std::size_t refused_by_crossing = 0;  ///< triangles would cross

    /// Makes the bounds of what was drawn those of what is left of it. Triangles that do not keep e
    /// have the bounds that they had.
    void hand_to(ErrorBounds& bounds, double& surface_error) const {
        bounds.error_bound = exceeding == 0 ? error : std::max(error, bounds.error_bound);
        surface_error = exceeding == 0 ? error : std::max(error, surface_error);
    }
};

/// The part of the error with which a surface is best drawn before its edges are collapsed within
/// the whole: with less there are more edges to collapse, and as many are left; with more there is
/// no room to move.
inline constexpr double collapse_start = 0.75;

/// Collapses edges of a surface that isosurface() or isosurface_within() has drawn, without a cap.
/// Best begun with one of three quarters of the error (collapse_start), or of half the distance.
///
/// Afterwards the surface has vertices, triangles and boundary edges, and normals and attributes
/// where it had them: normals from its triangles, attributes of the data at its vertices. What is
/// told of elements is gone. Triangles in elements with bent faces are refused where it cannot be
/// decided that they keep e. Where there is a distance without an error, triangles stay in the
/// domain, but may enter what is hidden.
/// \param isovalue C
/// \param bounds of the same grid and field: a HierarchicalIndicator, or other Bounds
/// \throw InvalidInput where an option or the isovalue is out of range, where neither an error nor
/// a
///        distance is asked for, or the hierarchy has another dimension
/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
Collapsed collapse(Surface<3>& surface, const Hierarchy<Real>& hierarchy, double isovalue,
                   const Bounds& bounds, const CollapseOptions& options,
                   const Executor& executor = SequentialExecutor{});

}  // namespace nestgrid
