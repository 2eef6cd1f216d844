// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Splits the triangles of a coloured surface until their colours follow the data.
//
// Colours are linear on triangles. In hexahedra, prisms and pyramids the data are multilinear, and
// colours are exact at vertices and on grid edges only. A cubic polynomial on a triangle is fixed
// by its values at the corners, at two points of each side and at the centre, and where it vanishes
// at the corners it is at most 2.2 times the greatest of the others. So sides and triangles are
// split where the data, probed there, differ from the colour by more than tolerance / 2.2.
//
// Invariant: a side is split by what is probed on it, in all its triangles alike. Consequence: the
// surface has the same points and the same open, boundary and non-manifold edges as before, up to
// their being split, and colours stay continuous.
#pragma once

#include <functional>

#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// What refine_colours did, and how far colours are off.
struct ColourRefinement {
    std::size_t split = 0;  ///< sides
    /// Nothing is split for this: the greatest difference that was met at a probed point.
    double miss = 0;
};

namespace detail {

using ProbePoints = std::function<ProbeResult(std::span<const Point>)>;
ColourRefinement refine_colours(Surface<3>& surface, double tolerance, const ProbePoints& probe);

}  // namespace detail

/// Refines the colours of a slice, a boundary, a flat shading, or an isosurface with attributes.
/// Simplices are left as they are: their colours are exact. A side is halved at most ten times.
/// Data of higher degree that are drawn within an error are probed themselves, and colour the
/// vertices.
/// \param surface drawn from the hierarchy; its attributes are the last components of the field.
///        Triangles keep their element and their order, new vertices come behind the others
/// \param tolerance by which a colour may differ from P_S U inside an element whose map is affine,
///        in units of the data. Where it is not, the same is tried, and probed points keep it
/// \param prerolls of the hierarchy, or {grid, field}
/// \param projection that the surface was drawn with
/// \throw InvalidInput where the tolerance is not a positive number, or the surface has no
///        attributes, more of them than the field has components, or reference coordinates
/// \throw InvalidInput, GridError as probe()
ColourRefinement refine_colours(Surface<3>& surface, const Prerolls& prerolls, double tolerance,
                                const Projection& projection = {}, const Work& work = {});

}  // namespace nestgrid
