// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The band between two isovalues, as one mesh: the level sets around low <= U < high, both oriented
// away from the band.
#pragma once

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// Appends a surface with its orientation reversed: triangles turned, normals to the other side.
template <int dimension>
void append_reversed(Surface<dimension>& to, const Surface<dimension>& from);

namespace detail {

/// Makes one band of the surfaces of its two isovalues.
template <int dimension>
Isosurface<dimension> join_band(std::vector<Isosurface<dimension>> levels);

}  // namespace detail

/// The surface around low <= U < high inside the domain, in one traversal. Where both level sets
/// keep away from the boundary of the domain it is closed, and encloses volume_between().
/// \return counts and the larger error bound of the two level sets
/// \throw InvalidInput unless low < high, and for options.cap: caps of bands are not made
/// \throw GridError as extract_isosurfaces()
template <int dimension, class Real>
Isosurface<dimension> isoband(const Hierarchy<Real>& hierarchy, double low, double high,
                              const Criterion& criterion, const Bounds& bounds,
                              const IsosurfaceOptions& options = {},
                              const Executor& executor = SequentialExecutor{}) {
    if (!(low < high)) throw InvalidInput("the lower isovalue is not below the upper one");
    if (options.cap) throw InvalidInput("a band between two isovalues cannot be capped");
    const std::array<double, 2> isovalues{low, high};
    return detail::join_band(isosurfaces<dimension>(hierarchy, std::span<const double>(isovalues),
                                                    criterion, bounds, options, executor));
}
template <class Grid, class Field>
auto isoband(const Grid& grid, const Field& field, double low, double high,
             const Criterion& criterion, const Bounds& bounds,
             const IsosurfaceOptions& options = {},
             const Executor& executor = SequentialExecutor{}) {
    return isoband<detail::surface_dimension<Grid>()>(erase(grid, field), low, high, criterion,
                                                      bounds, options, executor);
}

}  // namespace nestgrid
