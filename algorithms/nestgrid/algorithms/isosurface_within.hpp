// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces that keep a distance from that of all data, there and back: each point of one surface
// is within it of the other one (Hausdorff distance).
//
// What a criterion draws is compared with the surface of all data. Where a point of either is too
// far from the other one, the elements that contain it are drawn finely, at first down to the size
// of the distance, then down to leaves, until no point is left. Points are not samples: a triangle
// is halved until the nearest points decide for all of it.
//
// Consequence: no part of the surface is lost, however thin; and the criterion decides how much is
// drawn, not how far that is. Take one that promises about the distance, such as a threshold on
// slope_deviations() (cut_indicator.hpp).
// Cost: beside the surface of all data, which must be there, for each round one surface, one search
// of nearest points for every triangle of both, and one walk over all elements.
#pragma once

#include <cstddef>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/nearness.hpp>

namespace nestgrid {

/// An isosurface, and what it took to keep the distance.
struct IsosurfaceWithin {
    Isosurface<3> isosurface;
    int rounds = 0;          ///< of finer drawing; 0 where the criterion was enough
    std::size_t points = 0;  ///< that were too far, in all rounds
};

/// What isosurface() draws with the same arguments, and more detail where it is farther than the
/// distance from the surface of all data. The result does not depend on the executor.
/// \param options at_nodes must be that of the surface of all data; a cap is not compared
/// \throw InvalidInput as isosurface(); where the distance is not positive, and where it cannot be
///        kept because `nearness.whole` is another surface than that of all data
/// \throw GridError as isosurface()
template <class Real>
IsosurfaceWithin isosurface_within(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const Nearness& nearness, const AnyCriterion& criterion,
                                   const Bounds& bounds, const IsosurfaceOptions& options = {},
                                   const Executor& executor = SequentialExecutor{});

}  // namespace nestgrid
