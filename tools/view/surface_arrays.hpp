// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The arrays of a surface in a frame, and what a page needs beside those that the surface has.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

#include "frame_reply.hpp"

namespace nestgrid::view {

/// Adds "positions", three float32 a vertex, and "indices", three uint32 a triangle, two a segment.
template <int dimension>
void write_mesh(FrameReply& reply, const Surface<dimension>& surface);

/// Adds "normals", four int8 a vertex: times 1/127, and the last is 0.
void write_short_normals(FrameReply& reply, std::span<const Point> normals);
/// Adds "normals", three float32 a vertex.
void write_normals(FrameReply& reply, std::span<const Point> normals);

/// Adds "values", one float32 a vertex: a component of the attributes.
/// \param component below the number of attributes of a vertex
void write_values(FrameReply& reply, const Surface<3>& surface, std::size_t component = 0);

/// Adds a part of the kind "outlines", with the number of its segments.
/// \throw InvalidInput as outlines()
void write_outlines(FrameReply& reply, const Surface<3>& surface);

/// Adds a part of the kind "isolines", with the number of its segments: those of attribute 0.
/// \throw InvalidInput as isolines()
void write_isolines(FrameReply& reply, const Surface<3>& surface, std::span<const double> values);

/// The means of the normals of the triangles around each vertex, weighted by area: in a tenth of
/// the time that gradients take.
std::vector<Point> normals_from_triangles(const Surface<3>& surface);

/// Takes vertices of a surface apart where triangles around them meet at more than 40 degrees, and
/// gives each the mean normal of its triangles, as caps and boundaries need it. Of what else there
/// is, attributes are kept.
Surface<3> with_creases(const Surface<3>& surface);

}  // namespace nestgrid::view
