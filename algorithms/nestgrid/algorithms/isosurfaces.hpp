// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Several isosurfaces in one traversal, and isosurfaces into sinks. What holds of each surface,
// isosurface.hpp says.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/detail/surface_targets.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

namespace detail {

/// Draws into targets, or into the results where there are none.
template <int dimension>
std::vector<Isosurface<dimension>> draw_isosurfaces(const Prerolls& prerolls,
                                                    std::span<const double> isovalues,
                                                    const SurfaceTargets<dimension>& targets,
                                                    const Projection& projection,
                                                    const IsosurfaceOptions& options,
                                                    const Work& work);

}  // namespace detail

/// The isosurfaces U = isovalues[i] of component 0 of the field, at one threshold.
/// \return one result for each isovalue
/// \throw InvalidInput also where an isovalue is not a number, for collapses, distances that are
///        kept, and a number of triangles
template <int dimension>
std::vector<Isosurface<dimension>> isosurfaces(const Prerolls& prerolls,
                                               std::span<const double> isovalues,
                                               const Projection& projection = {},
                                               const IsosurfaceOptions& options = {},
                                               const Work& work = {}) {
    return detail::draw_isosurfaces<dimension>(prerolls, isovalues, {}, projection, options, work);
}
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid>
auto isosurfaces(const Grid& grid, const Field& field, std::span<const double> isovalues,
                 const Projection& projection = {}, const IsosurfaceOptions& options = {},
                 const Work& work = {}) {
    return isosurfaces<detail::surface_dimension<Grid>()>(Prerolls(grid, field), isovalues,
                                                          projection, options, work);
}

/// Draws the isosurfaces into sinks (surface.hpp), a MeshSink or a SimplexSink of the grid's
/// dimension for each. The surfaces of the results stay empty.
/// \throw InvalidInput also where there is not one sink for each isovalue, and for normals into a
///        SimplexSink
template <int dimension, class Sink>
std::vector<Isosurface<dimension>> extract_isosurfaces(const Prerolls& prerolls,
                                                       std::span<const double> isovalues,
                                                       std::vector<Sink> sinks,
                                                       const Projection& projection = {},
                                                       const IsosurfaceOptions& options = {},
                                                       const Work& work = {}) {
    return detail::draw_isosurfaces<dimension>(
        prerolls, isovalues, detail::targets_of<dimension>(sinks), projection, options, work);
}
template <class Grid, class Field, class Sink>
    requires detail::FieldOfGrid<Field, Grid>
auto extract_isosurfaces(const Grid& grid, const Field& field, std::span<const double> isovalues,
                         std::vector<Sink> sinks, const Projection& projection = {},
                         const IsosurfaceOptions& options = {}, const Work& work = {}) {
    return extract_isosurfaces<detail::surface_dimension<Grid>()>(
        Prerolls(grid, field), isovalues, std::move(sinks), projection, options, work);
}

}  // namespace nestgrid
