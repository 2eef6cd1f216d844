// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid {

/// What there is to know about a triangle surface. Everything is counted from the indices alone;
/// vertices are never compared by position.
struct SurfaceReport {
    std::size_t vertices = 0;  ///< that belong to a triangle
    std::size_t edges = 0;
    std::size_t triangles = 0;
    std::size_t open_edges = 0;            ///< of one triangle only, inside the domain: cracks
    std::size_t boundary_edges = 0;        ///< of one triangle only, on the boundary of the domain
    std::size_t nonmanifold_edges = 0;     ///< of more than two triangles
    std::size_t misoriented_edges = 0;     ///< of two triangles that disagree about the outside
    std::size_t nonmanifold_vertices = 0;  ///< whose triangles do not form one fan
    /// Whose corners are on a line, or at one place, up to the rounding of their positions. The
    /// data make them where they are constant around the isovalue.
    std::size_t degenerate_triangles = 0;
    std::size_t components = 0;
    long long euler = 0;  ///< vertices - edges + triangles
    double area = 0;
    /// The part of the area behind its normals: a third of a triangle for each of its corners
    /// whose normal points to the other side. 0 where the surface has no normals.
    double area_behind = 0;
    double volume = 0;  ///< enclosed, positive for U >= C inside; 0 unless closed

    /// No edge belongs to one triangle only.
    bool closed() const { return open_edges == 0 && boundary_edges == 0; }
    bool manifold() const {
        return nonmanifold_edges == 0 && nonmanifold_vertices == 0 && misoriented_edges == 0;
    }
};

/// Counts and measures a triangle surface.
/// \throw InvalidInput where a triangle repeats a vertex or names one that does not exist
SurfaceReport surface_report(const Surface<3>& surface);

}  // namespace nestgrid
