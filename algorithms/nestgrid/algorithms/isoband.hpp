// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The band between two isovalues, as one mesh: the level sets around low <= U < high, both oriented
// away from the band.
#pragma once

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

/// The surface around low <= U < high inside the domain, in one traversal. Where both level sets
/// keep away from the boundary of the domain it is closed, and encloses volume_between().
/// \return counts and the larger error bound of the two level sets; a number of triangles is one of
///         both together
/// \throw InvalidInput also unless low < high, for options.cap: caps of bands are not made; for
///        collapses
template <int dimension>
Projected<Isosurface<dimension>> isoband(const Prerolls& prerolls, double low, double high,
                                         const Projection& projection = {},
                                         const IsosurfaceOptions& options = {},
                                         const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid>
auto isoband(const Grid& grid, const Field& field, double low, double high,
             const Projection& projection = {}, const IsosurfaceOptions& options = {},
             const Work& work = {}) {
    return isoband<detail::surface_dimension<Grid>()>(Prerolls(grid, field), low, high, projection,
                                                      options, work);
}

}  // namespace nestgrid
