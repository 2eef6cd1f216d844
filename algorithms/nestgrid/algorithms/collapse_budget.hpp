// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least error at which an isosurface can be collapsed (collapse.hpp) to a number of triangles.
//
// Errors are searched among bfloat16 numbers. Each trial draws with a part of the error
// (collapse_start) and collapses within it; the next one is interpolated between those that exceed the
// number and those that keep within it.
// Promise: the surface of the error that is found keeps within the number, and has nine tenths of
// it, or the next lesser bfloat16 number has more triangles.
// Not promised: that no lesser error keeps within the number, as triangles get fewer with the error
// on the whole, but not at each step.
// Cost: mostly three to five surfaces and their collapses.
#pragma once

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

namespace nestgrid {

namespace detail {

/// Defined for float and double.
template <class Real>
TriangleBudget find_collapse_error(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const MakeCriterion& criterion_at, const SearchBounds& bounds,
                                   std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                   const Executor& executor);

}  // namespace detail

/// The least error such that the isosurface that is drawn with collapse_start of it, and then collapsed
/// within it, has at most max_triangles. It is the `threshold` of the result; where that is 0, all
/// data have no more triangles, and nothing is to be collapsed.
/// \param criterion_at of an error, such as a Threshold on deviations
/// \param bounds of the same grid and field, for collapse(), too
/// \param options of the surface without a cap; progress is told while surfaces are drawn
/// \throw InvalidInput where collapses leave more triangles at any error, and as isosurface()
template <class Real, MakesCriterion Make, RangedBounds Ranged>
TriangleBudget find_collapse_error(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const Make& criterion_at, const Ranged& bounds,
                                   std::uint64_t max_triangles,
                                   const IsosurfaceOptions& options = {},
                                   const Executor& executor = SequentialExecutor{}) {
    hierarchy.facts().require_dimension(3);
    return detail::with_made(criterion_at, [&](const detail::MakeCriterion& make) {
        return detail::find_collapse_error(hierarchy, isovalue, make,
                                           {bounds, bounds.greatest() - bounds.least()},
                                           max_triangles, options, executor);
    });
}
template <class Grid, class Field, MakesCriterion Make, RangedBounds Ranged>
    requires(!detail::AnyHierarchy<Grid>)
TriangleBudget find_collapse_error(const Grid& grid, const Field& field, double isovalue,
                                   const Make& criterion_at, const Ranged& bounds,
                                   std::uint64_t max_triangles,
                                   const IsosurfaceOptions& options = {},
                                   const Executor& executor = SequentialExecutor{}) {
    return find_collapse_error(erase(grid, field), isovalue, criterion_at, bounds, max_triangles,
                               options, executor);
}

}  // namespace nestgrid
