// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The adaptive grid of a two-dimensional hierarchy as a conforming triangulation that carries the
// field, in the plane or on a surface in space (paper, sections 2, 3 and 5.2).
//
// Invariants, with a saturated criterion:
//   - nodes of a finer side are vertices of the coarser element, with values linear along its edge;
//   - a vertex is named by the key of its node, or lies inside one element;
//   - the diagonal of a quadrilateral is chosen by the positions and values of its corners.
// Consequence: every inner edge belongs to two triangles, the drawn function is continuous, and
// nothing depends on numbers of nodes or on threads.
#pragma once

#include <nestgrid/algorithms/projected.hpp>
#include <nestgrid/algorithms/shading_options.hpp>

namespace nestgrid {

/// Draws the elements at which the projection stops, with all components of the field as
/// attributes: in the plane, or on the grid's surface in space.
/// \throw InvalidInput also where options.flatness is negative or not a number
Projected<Shading> shading(const Prerolls& prerolls, const Projection& projection = {},
                           const ShadingOptions& options = {}, const Work& work = {});
template <class Grid, class Field>
    requires detail::FieldOfGrid<Field, Grid> Projected<Shading> shading(
        const Grid& grid, const Field& field, const Projection& projection = {},
        const ShadingOptions& options = {}, const Work& work = {}) {
        return shading(Prerolls(grid, field), projection, options, work);
    }

}  // namespace nestgrid
