// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Points that stand for the area of a surface.
#pragma once

#include <cstddef>
#include <vector>

#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid::engine {

/// Points, with the area that each stands for.
struct SurfacePoints {
    std::vector<Point> x;
    std::vector<double> area;
    double reach = 0;  ///< no point of the triangles is farther from all of these
};

/// The middles of congruent parts of triangles, which are no longer than a length.
/// \param first, last of the triangles
SurfacePoints points_of(const Surface<3>& surface, std::size_t first, std::size_t last,
                        double length);

}  // namespace nestgrid::engine
