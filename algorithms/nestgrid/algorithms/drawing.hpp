// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// All that is drawn of a field as finely as a projection says: one call from a wish to what is
// drawn, with the indicators that earlier calls have made.
//
//     const Prerolls prerolls(grid, field);
//     const auto drawn = isosurface<3>(prerolls, 12.0, {.threshold = 0.1, .indicator = "error"});
//
// What holds of all drawings, projected.hpp says.
#pragma once

#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/slice.hpp>

namespace nestgrid {

/// The error within which polynomials are drawn where nobody asks for one: a thousandth of their
/// range.
double default_error(const HighOrder& data);

/// The projection by which a front end draws a field: this one, but of a field of higher degree
/// always one within an error. That is default_error() where the projection asks for nothing, the
/// least one with its number of triangles where it asks for such a number by offsets, and any error
/// where a lens decides alone.
///
/// \throw InvalidInput as Projection::require_error_alone(), and as HighOrder
Projection with_error(const Prerolls& prerolls, Projection projection, const Work& work = {});

}  // namespace nestgrid
