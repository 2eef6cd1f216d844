// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Data of higher degree at points: what evaluate() of the field gives there, and its gradient
// (docs/high_order.md).
#pragma once

#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// The polynomials of the leaves at points, found as probe() of a hierarchy finds them. Where data
/// jump, a point on the border of several leaves takes those of one of them. Points of curved leaves
/// that no drawn element has are found in the leaves beside them.
/// \return all but element_of and elements: `reference` lies in the leaf
/// \throw InvalidInput where a coordinate is not finite
ProbeResult probe(const HighOrder& data, std::span<const Point> points);

/// Sets the normals of a surface to those of the level sets of component 0 at each vertex, towards
/// lesser values; 0 where the gradient vanishes. A vertex on a curved boundary, which is drawn
/// elsewhere, takes the nearest leaf. Where triangles are coarse some face away from
/// them: settle_normals() turns these.
void set_polynomial_normals(Surface<3>& surface, const HighOrder& data);

/// Sets the attributes of a surface to the last components of the data at each vertex: as many as
/// it has, so that those that were interpolated in drawn elements become those of the polynomials.
/// \throw InvalidInput where the surface has more than the data have components
void set_polynomial_colours(Surface<3>& surface, const HighOrder& data);

}  // namespace nestgrid
