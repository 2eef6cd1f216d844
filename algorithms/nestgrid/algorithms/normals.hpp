// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals that agree with the triangles of a surface. Gradients of the data give smooth normals,
// but where elements are coarse these point behind some of the triangles that are drawn, and a
// renderer shows them black.
#pragma once

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// Turns each normal that does not agree with the triangles around its vertex, and makes those that
/// are 0.
///
/// A normal agrees where its cosine with every triangle around is at least 0.2. Else it is turned
/// towards the mean of these triangles, weighted by area, until it agrees (to half the least cosine
/// of the mean, where that is less than 0.4); one that is more than 60 degrees away from the mean
/// becomes the mean. Where the mean itself is behind a triangle, the direction whose least cosine
/// with the triangles is greatest takes its place. Where even that cosine is not above 0, the fan
/// is folded over itself: the normal is then behind some of its triangles. Triangles so flat that
/// rounding decides about their direction do not count.
///
/// Surfaces that isosurface() and its relatives draw with normals have settled ones.
/// \param surface whose normals are of unit length, or 0 where none is known; all are made where
///        there are none
/// \return the number of vertices with a fan folded over itself
std::size_t settle_normals(Surface<3>& surface);

}  // namespace nestgrid
