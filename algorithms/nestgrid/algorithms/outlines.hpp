// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The edges of the extracted elements on a surface: they show where the traversal stopped, as in
// the figures of the paper.
#pragma once

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// The segments in which faces of the extracted elements meet a surface. The triangles of one
/// element have such a side once, and their other sides twice. A side that two elements share
/// becomes one segment, directed as in the first of them. Where a coarse and a finer element meet,
/// the segments are those of the finer one.
/// Vertices keep their normals and attributes; those on no segment are left out. Takes time and
/// memory proportional to the size of the surface.
/// \param surface keeps its elements (IsosurfaceOptions::elements); the triangles of an element
///        follow each other
/// \throw InvalidInput where the surface does not keep its elements, and where a triangle names a
///        vertex that does not exist
Surface<2> outlines(const Surface<3>& surface);

}  // namespace nestgrid
