// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines of two-dimensional grids as joined lines (paper, sections 3 and 8). Those on surfaces
// are in surface_isolines.hpp, which this header includes.
#pragma once

#include <span>

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/projected.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>

namespace nestgrid {

/// Isolines of a two-dimensional grid. On every line U differs from its value by at most
/// error_bound; the range_bound is the greatest difference anywhere from any of the values.
struct Isolines : ErrorBounds {
    Polylines lines;
    TraversalCounts counts;  ///< elements are counted as extracted once for each value
    bool cancelled = false;  ///< by options.progress; the lines are then a part
    /// On curved leaves, as of Isosurface.
    double position_bound = 0;
};

/// The isolines of component 0 of a field of dimension 2, in one traversal. They end on the
/// boundary of the domain only. Vertices carry components 1 ... of the field. A number of triangles
/// is one of segments, of all lines together.
/// \param options as of isosurface(); normals, elements and references are not kept
///
/// \throw InvalidInput also where a value is not a number, and for collapses
Projected<Isolines> isolines(const Prerolls& prerolls, std::span<const double> values,
                             const Projection& projection = {},
                             const IsosurfaceOptions& options = {}, const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> Projected<Isolines> isolines(
        const Grid& grid, const Field& field, std::span<const double> values,
        const Projection& projection = {}, const IsosurfaceOptions& options = {},
        const Work& work = {}) {
        return isolines(Prerolls(grid, field), values, projection, options, work);
    }

}  // namespace nestgrid
