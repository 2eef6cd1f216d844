// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A slice of a hierarchy of dimension 3: the zero of a function of position, coloured by the data
// (paper, sections 2, 3 and 5.2). Geometry decides where the slice runs, the data decide how fine
// it is, and only elements that the function may pass through are visited. Several slices and
// isosurfaces share one traversal in slices.hpp.
//
// Invariants:
//   - a plane that runs through nodes, edges or faces has its vertices there, and takes each point
//     once; where nodes lie means of others, vertices are on the plane up to rounding;
//   - colours are the values of P_S U at vertices and linear on triangles: continuous across all
//     changes of level and shape.
// Where a grid gives true positions of new nodes, options.position_bounds tell which elements the
// function may pass through; without them all are visited.
// On a curved slice, elements stop where the data allow it: combine the criterion with DeepestLevel
// or NodeLevels to follow the function more closely.
#pragma once

#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/level_function.hpp>
#include <nestgrid/algorithms/projected.hpp>

namespace nestgrid {

/// Attribute c of a vertex is component c of the field. The error bound is that of the colour of
/// component 0: on every triangle it differs by at most this from U, at the same place.
using Slice = Isosurface<3>;

/// The slice along the zero of a function. Where all data are asked for, it needs no preroll.
/// Colours keep the threshold where edges are collapsed, or the least one with a number of
/// triangles.
/// \param options vertices are put at nodes in any case
/// \throw InvalidInput also where the function has no finite value
Projected<Slice> slice(const Prerolls& prerolls, const LevelFunction& function,
                       const Projection& projection = {}, const IsosurfaceOptions& options = {},
                       const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> Projected<Slice> slice(
        const Grid& grid, const Field& field, const LevelFunction& function,
        const Projection& projection = {}, const IsosurfaceOptions& options = {},
        const Work& work = {}) {
        return slice(Prerolls(grid, field), function, projection, options, work);
    }

}  // namespace nestgrid
