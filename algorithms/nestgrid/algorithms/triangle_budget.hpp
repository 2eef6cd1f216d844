// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The least threshold whose surface keeps within a number of triangles.
//
// Stopping numbers are bfloat16, so S changes at these 2^15 thresholds only: the search is one over
// integers. It ends between two neighbours, of which the greater threshold keeps within the budget
// and the lesser one does not.
// Cost: every trial ends when the budget is exceeded. Threshold 0 is tried first; then thresholds
// are halved from the greatest one until the budget is exceeded, and 7 bisections remain, for an
// octave has 128 numbers: at most 10 times the budget, and what fitted before the last halving.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid {

struct TriangleBudget {
    double threshold = 0;
    std::uint64_t triangles = 0;  ///< of the surface at it
    std::uint64_t extracted = 0;  ///< over all trials: the cost of the search
    int trials = 0;
};

namespace detail {

/// Triangles (segments) under a criterion, or nothing where there are more than `most`.
template <class Grid, class Field, class S, class Indicator, class Executor>
std::optional<std::uint64_t> count_triangles(const Grid& grid, const Field& field, double isovalue,
                                             const S& criterion, const Indicator& indicator,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor) {
    using Sink = SurfaceSink<Grid::dimension, ElementOf<Grid>>;
    using Visitor = IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>;
    IsosurfaceOptions plain;
    plain.cap = options.cap;
    plain.progress = options.progress;
    const typename Visitor::Walk walk(grid, field, indicator.hanging());
    typename Sink::Target nothing;
    Visitor visitor(walk, std::span<const double>(&isovalue, 1), {Sink(nothing, false)}, criterion,
                    indicator, plain);
    visitor.count_only(most);
    try {
        visitor.run(executor);
    } catch (const OverLimit&) {
        return std::nullopt;
    }
    return visitor.simplices();
}

}  // namespace detail

/// \param criterion_at the criterion for a threshold: S(double), one that holds at more nodes the
///        greater the threshold is; fine_inside (region.hpp) with a threshold of its own, say
/// \param options cap and progress count
/// \throw InvalidInput where even the coarsest surface has more than max_triangles
template <class Grid, class Field, class MakeCriterion, class Indicator,
          Executor E = SequentialExecutor>
    requires requires(const MakeCriterion& make) {
        { make(0.0) } -> Criterion;
    }
TriangleBudget find_threshold(const Grid& grid, const Field& field, double isovalue,
                              const MakeCriterion& criterion_at, const Indicator& indicator,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options = {},
                              const E& executor = {}) {
    TriangleBudget best;
    const auto fits = [&](std::uint16_t code) {
        const double threshold = bfloat16_value(code);
        const auto count = detail::count_triangles(grid, field, isovalue, criterion_at(threshold),
                                                   indicator, max_triangles, options, executor);
        ++best.trials;
        best.extracted += count.value_or(max_triangles + 1);
        if (count) {
            best.threshold = threshold;
            best.triangles = *count;
        }
        return count.has_value();
    };
    if (fits(0)) return best;
    // The greatest stopping number is at most the range of the data.
    std::uint16_t within = bfloat16_above(float_above(indicator.greatest() - indicator.least()));
    if (within == 0 || !fits(within)) {
        const auto coarsest = detail::count_triangles(
            grid, field, isovalue, criterion_at(bfloat16_value(within)), indicator,
            std::numeric_limits<std::uint64_t>::max(), options, executor);
        throw InvalidInput("even the coarsest surface has more than " +
                           std::to_string(max_triangles) +
                           " triangles: " + std::to_string(*coarsest));
    }
    constexpr std::uint16_t octave = 128;
    const auto halved = [](std::uint16_t code) {
        return static_cast<std::uint16_t>(code > octave ? code - octave : 0);
    };
    std::uint16_t beyond = halved(within);
    while (beyond > 0 && fits(beyond)) {
        within = beyond;
        beyond = halved(within);
    }
    while (within - beyond > 1) {
        const auto middle = static_cast<std::uint16_t>((within + beyond) / 2);
        (fits(middle) ? within : beyond) = middle;
    }
    return best;
}

/// The same for one threshold everywhere.
template <class Grid, class Field, class Indicator, Executor E = SequentialExecutor>
TriangleBudget find_threshold(const Grid& grid, const Field& field, double isovalue,
                              const Indicator& indicator, std::uint64_t max_triangles,
                              const IsosurfaceOptions& options = {}, const E& executor = {}) {
    const auto everywhere = [&](double threshold) {
        return Threshold<Indicator>{&indicator, threshold};
    };
    return find_threshold(grid, field, isovalue, everywhere, indicator, max_triangles, options,
                          executor);
}

/// S from options.threshold or options.max_triangles.
/// \throw InvalidInput where the threshold is negative or not a number, and where even the coarsest
///        surface has more triangles than asked for
template <class Grid, class Field, class Indicator, Executor E = SequentialExecutor>
Threshold<Indicator> criterion_for(const Grid& grid, const Field& field, double isovalue,
                                   const Indicator& indicator, const IsosurfaceOptions& options,
                                   const E& executor = {}) {
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    Threshold<Indicator> criterion{&indicator, options.threshold};
    if (options.max_triangles > 0) {
        if constexpr (requires { indicator.greatest() - indicator.least(); }) {
            criterion.epsilon = find_threshold(grid, field, isovalue, indicator,
                                               options.max_triangles, options, executor)
                                    .threshold;
        } else {
            throw InvalidInput("a budget of triangles needs an indicator that knows its range");
        }
    }
    return criterion;
}

template <class Grid, class Field, class Indicator, Executor E>
    requires requires(const Indicator& i) { i.stop(NodeKey{}); }
Isosurface<Grid::dimension, ElementOf<Grid>> isosurface(const Grid& grid, const Field& field,
                                                        double isovalue, const Indicator& indicator,
                                                        const IsosurfaceOptions& options,
                                                        const E& executor) {
    return isosurface(grid, field, isovalue,
                      criterion_for(grid, field, isovalue, indicator, options, executor), indicator,
                      options, executor);
}

}  // namespace nestgrid
