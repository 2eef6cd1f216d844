// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least threshold whose surface keeps within a number of triangles: that of an isosurface, of a
// slice, or of the triangles in the plane, under any criterion that has a threshold. What is
// promised, and at what cost, least_threshold.hpp says.
#pragma once

#include <concepts>
#include <functional>
#include <memory>

#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/level_function.hpp>

namespace nestgrid {

/// Bounds that know the range of the data: a HierarchicalIndicator, or KeyFrames between frames.
/// The search begins at the range.
template <class T>
concept RangedBounds = std::derived_from<T, Bounds> && requires(const T& bounds) {
    { bounds.least() } -> std::convertible_to<double>;
    { bounds.greatest() } -> std::convertible_to<double>;
};

/// Callables that make the criterion for a threshold from 0 to 3.4e38: one that holds at more nodes
/// the greater the threshold is, by any indicator; Blended, a lens or fine_inside (region.hpp) with
/// a threshold of its own, say.
template <class T>
concept MakesCriterion = requires(const T& make) {
    { make(0.0) } -> std::derived_from<Criterion>;
};

namespace detail {

using MakeCriterion = std::function<std::unique_ptr<const Criterion>(double threshold)>;

/// Where the search begins.
struct SearchBounds {
    const Bounds& bounds;
    double range;  ///< of the data, from which thresholds are searched
};

/// Defined for dimensions 2 and 3, float and double.
template <int dimension, class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, double isovalue,
                              const MakeCriterion& criterion_at, const SearchBounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor);
/// The same for a slice, with the triangles that it has before vertices are merged at nodes.
template <class Real>
TriangleBudget find_slice_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                                    const MakeCriterion& criterion_at, const SearchBounds& bounds,
                                    std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                    const Executor& executor);

/// Calls find(make) with a function that makes a criterion on the heap.
template <class Criteria, class Find>
TriangleBudget with_made(const Criteria& criterion_at, const Find& find) {
    using S = decltype(criterion_at(0.0));
    const MakeCriterion make = [&](double threshold) {
        return std::make_unique<const S>(criterion_at(threshold));
    };
    return find(make);
}

}  // namespace detail

/// The least threshold at which an isosurface has at most max_triangles.
/// \param options cap and progress count
/// \throw InvalidInput where even the coarsest surface has more than max_triangles, and for a
///        hierarchy of another dimension
template <int dimension, class Real, MakesCriterion Make, RangedBounds Ranged>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, double isovalue,
                              const Make& criterion_at, const Ranged& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options = {},
                              const Executor& executor = SequentialExecutor{}) {
    hierarchy.facts().require_dimension(dimension);
    return detail::with_made(criterion_at, [&](const detail::MakeCriterion& make) {
        return detail::find_threshold<dimension>(hierarchy, isovalue, make,
                                                 {bounds, bounds.greatest() - bounds.least()},
                                                 max_triangles, options, executor);
    });
}
/// The same for the slice along the zero of a function. Triangles are counted before vertices are
/// merged at nodes: the slice has no more.
template <class Real, MakesCriterion Make, RangedBounds Ranged>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                              const Make& criterion_at, const Ranged& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options = {},
                              const Executor& executor = SequentialExecutor{}) {
    return detail::with_made(criterion_at, [&](const detail::MakeCriterion& make) {
        return detail::find_slice_threshold(hierarchy, function, make,
                                            {bounds, bounds.greatest() - bounds.least()},
                                            max_triangles, options, executor);
    });
}

/// The same for the shading of a hierarchy of dimension 2, or for its height fields, which all have
/// as many triangles. Of the options, flatness and progress count.
template <class Real, MakesCriterion Make, RangedBounds Ranged>
TriangleBudget find_shading_threshold(const Hierarchy<Real>& hierarchy, const Make& criterion_at,
                                      const Ranged& bounds, std::uint64_t max_triangles,
                                      const ShadingOptions& options = {},
                                      const Executor& executor = SequentialExecutor{}) {
    return least_threshold(
        [&](double threshold, std::uint64_t most) {
            return count_triangles(hierarchy, under(criterion_at(threshold), bounds), most, options,
                                   {executor});
        },
        bounds.greatest() - bounds.least(), max_triangles);
}

/// The same for an isosurface with the indicator's own criterion.
template <int dimension, class Real, RangedBounds Ranged>
    requires std::derived_from<Ranged, Indicator> TriangleBudget
    find_threshold(const Hierarchy<Real>& hierarchy, double isovalue, const Ranged& indicator,
                   std::uint64_t max_triangles, const IsosurfaceOptions& options = {},
                   const Executor& executor = SequentialExecutor{}) {
        const auto everywhere = [&](double threshold) { return Threshold(&indicator, threshold); };
        return find_threshold<dimension>(hierarchy, isovalue, everywhere, indicator, max_triangles,
                                         options, executor);
    }

}  // namespace nestgrid
