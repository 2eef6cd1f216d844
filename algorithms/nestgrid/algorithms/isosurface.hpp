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
//
//     const auto drawn = isosurface(grid, field, 12.0, {.threshold = 0.1});
//
// For several drawings of a field keep its prerolls: isosurface<3>(prerolls, 12.0). What holds of
// all drawings, projected.hpp says. Several surfaces share one traversal in isosurfaces.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/projected.hpp>

namespace nestgrid {

/// The isosurface U = isovalue of component 0 of a field of dimension 3, or the isoline of one of
/// dimension 2. Edges are collapsed, and distances kept, in dimension 3.
/// \throw InvalidInput also where the isovalue is not a number, and where an isosurface that is
///        collapsed is to have a cap or vertices at nodes
template <int dimension>
Projected<Isosurface<dimension>> isosurface(const Prerolls& prerolls, double isovalue,
                                            const Projection& projection = {},
                                            const IsosurfaceOptions& options = {},
                                            const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid>
auto isosurface(const Grid& grid, const Field& field, double isovalue,
                const Projection& projection = {}, const IsosurfaceOptions& options = {},
                const Work& work = {}) {
    return isosurface<detail::surface_dimension<Grid>()>(Prerolls(grid, field), isovalue,
                                                         projection, options, work);
}

}  // namespace nestgrid
