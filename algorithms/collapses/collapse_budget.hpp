// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least error, or distance, at which what is drawn can be collapsed (collapse.hpp,
// collapse_colours.hpp) to a number of triangles.
//
// Both are searched among bfloat16 numbers. Each trial draws with a part of the number
// (collapse_start of an error, half of a distance) and collapses within it; the next one is
// interpolated between those that leave too many triangles and those that do not.
// Promise: the surface of the number that is found has no more triangles than it may, and nine
// tenths of them, or the next lesser bfloat16 number leaves more.
// Not promised: that no lesser number is enough, as triangles get fewer with it on the whole, but
// not at each step.
// Cost: mostly three to five surfaces and their collapses.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/projection.hpp>

namespace nestgrid::engine {

/// How many triangles were drawn, and how many collapses left of them.
struct CollapseTrial {
    std::uint64_t drawn = 0;
    std::uint64_t left = 0;
};
/// Draws what may then be off by a part of an error, and collapses it within the whole; at error 0
/// draws all data. Returns nothing where it was cancelled.
using TryCollapse = std::function<std::optional<CollapseTrial>(double error)>;

/// The least error within which a drawing, whatever it is, is collapsed to at most max_triangles.
/// It is the `threshold` of the result; where that is 0, all data have no more triangles.
/// \param range of the data, in the unit of the error
///
/// \throw InvalidInput where collapses leave more triangles at twice the range, and what the trials
///        throw
TriangleBudget find_collapse_error(const TryCollapse& within, double range,
                                   std::uint64_t max_triangles);

/// The least error such that the isosurface that is drawn with collapse_start of it, and then
/// collapsed within it, has at most max_triangles. It is the `threshold` of the result; where that
/// is 0, all data have no more triangles, and nothing is to be collapsed.
/// \param criterion_at of an error, such as a Threshold on deviations
/// \param bounds of the same grid and field, which know the range of the data; for collapse(), too
/// \param options of the surface without a cap; progress is told while surfaces are drawn
///
/// \throw InvalidInput where collapses leave more triangles at any error, and as isosurface()
template <class Real>
TriangleBudget find_collapse_error(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const CriterionAt& criterion_at, const Bounds& bounds,
                                   std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                   const Executor& executor);

/// The least distance such that the isosurface that isosurface_within() draws with half of it, and
/// that is then collapsed within it, has at most max_triangles. It is the `threshold` of the
/// result; where that is 0, all data have no more triangles. Less than about a thirtieth of the
/// edges of so many triangles is not tried.
/// \param whole the isosurface of all data
/// \param criterion_at of a distance, such as a Threshold on slope_deviations() (cut_indicator.hpp)
/// \param bounds of the same grid and field
/// \param options of the surface without a cap, as for isosurface_within()
///
/// \throw InvalidInput where collapses leave more triangles at any distance, and as
///        isosurface_within()
template <class Real>
TriangleBudget find_collapse_distance(const Hierarchy<Real>& hierarchy, double isovalue,
                                      const Surface<3>& whole, const CriterionAt& criterion_at,
                                      const Bounds& bounds, std::uint64_t max_triangles,
                                      const IsosurfaceOptions& options, const Executor& executor);

}  // namespace nestgrid::engine
