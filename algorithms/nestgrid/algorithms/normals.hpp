// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Normals that agree with the triangles of a surface. Gradients of the data give smooth normals,
// but where elements are coarse these point behind some of the triangles that are drawn, and a
// renderer shows them black.
#pragma once

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// Replaces each normal that does not agree with the triangles around its vertex, or that is 0.
///
/// A normal agrees where its cosine with every triangle around is at least 0.2. Else it becomes the
/// mean of these triangles, weighted by area, where the cosine of that with each is at least 0.02;
/// else that mean is turned towards the direction whose least cosine with them is greatest, until it
/// agrees. Where even that cosine is not above 0, the fan is folded over itself: the normal is then
/// the mean, behind some of its triangles.
///
/// Surfaces that isosurface() and its relatives draw with normals have settled ones.
/// \param surface whose normals are of unit length, or 0 where none is known; all are made where
///        there are none
/// \return the number of vertices with a fan folded over itself
std::size_t settle_normals(Surface<3>& surface);

}  // namespace nestgrid
