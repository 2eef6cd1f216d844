// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What nestgrid/algorithms/normals.hpp does, for surfaces that a sink has taken, too.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// \param x positions of the vertices
/// \param normals of the vertices, of unit length, or 0 where none is known
/// \param extent the extent of all vertices
/// \return the number of vertices with a fan folded over itself
std::size_t settle_normals(std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const Point> x, std::span<Point> normals, double extent);

/// The greatest distance from the origin.
double extent_of(std::span<const Point> x);

}  // namespace nestgrid::engine
