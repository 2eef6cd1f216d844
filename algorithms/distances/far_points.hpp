// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <distances/closest_points.hpp>
#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::engine {

/// A point of each triangle of a surface that is not within a distance of another surface as a
/// whole. Where there is none, no point of the surface is farther than that. A triangle that comes
/// within a thousandth of the distance may be among them although it keeps it.
std::vector<Point> far_points(const Surface<3>& from, const ClosestPoints& to, double distance,
                              const Executor& executor);

}  // namespace nestgrid::engine
