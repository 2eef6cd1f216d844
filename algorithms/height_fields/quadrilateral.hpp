// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which triangles draw a quadrilateral, and how far they are from what it interpolates.
//
// Invariant: both depend on the positions and values of the corners only, not on their numbers, nor
// on the way around.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// The parameters by which all elements are triangulated.
struct GraphShape {
    double lift = 0;  ///< vertices are lifted along z by this times component 0
    double flatness;  ///< the greatest twist of a quadrilateral that two triangles draw

    Point lifted(Point x, double u) const {
        if (lift != 0) x[2] += lift * u;
        return x;
    }
};

/// The corners of a quadrilateral in the order of its shape: diagonal 0 joins corners 0 and 3,
/// diagonal 1 the others.
using QuadrilateralCorners = std::span<const Point, 4>;

/// Whether each diagonal divides the quadrilateral into triangles that are turned the same way.
std::array<bool, 2> dividing_diagonals(QuadrilateralCorners x);

/// The diagonal that is shorter after lifting. Of two that are equally long, it is the one whose
/// ends have nearer values, or else the one with the corner that is least in lexicographic order.
/// \param u component 0 at the corners
std::size_t shorter_diagonal(QuadrilateralCorners x, const std::array<double, 4>& u,
                             const GraphShape& shape);

/// How far a component, bilinear on the element, is from two triangles: where the corners are those
/// of a parallelogram, this is the greatest difference.
/// \param u the component at the corners
inline double twist(const std::array<double, 4>& u) {
    return std::abs((u[0] - u[1]) - (u[2] - u[3])) / 4;
}

/// How far a component, interpolated from the corners, and the triangles that draw it differ.
/// \param nested whether all leaves below the element have its shape
/// \param centred whether the triangles have a vertex in the middle
double quadrilateral_chord(QuadrilateralCorners x, const std::array<double, 4>& u, bool nested,
                           bool centred);

}  // namespace nestgrid::engine
