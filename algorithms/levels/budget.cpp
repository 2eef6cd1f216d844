// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>

#include <levels/bfloat16_search.hpp>
#include <levels/draw.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace engine {

namespace {

using nestgrid::detail::MakeCriterion;
using nestgrid::detail::SearchBounds;

std::uint16_t halved(std::uint16_t code) {
    return static_cast<std::uint16_t>(code > octave ? code - octave : 0);
}

/// Searches for the threshold of a budget among bfloat16 numbers.
template <int dimension, class Real>
class BudgetSearch {
public:
    BudgetSearch(const Levels<Real>& levels, const MakeCriterion& criterion_at,
                 const SearchBounds& bounds, std::uint64_t max_triangles,
                 const IsosurfaceOptions& options, const Executor& executor)
        : levels_{levels},
          criterion_at_{criterion_at},
          bounds_{bounds},
          max_triangles_{max_triangles},
          options_{options},
          executor_{executor} {}

    TriangleBudget run() {
        if (fits(0)) return best_;
        // The greatest stopping number is at most the range of the data.
        std::uint16_t within = bfloat16_above(float_above(bounds_.range));
        if (within == 0 || !fits(within)) throw_too_few(within);
        std::uint16_t beyond = halved(within);
        while (beyond > 0 && fits(beyond)) {
            within = beyond;
            beyond = halved(within);
        }
        least_that_fits(beyond, within, [this](std::uint16_t code) { return fits(code); });
        return best_;
    }

private:
    std::optional<std::uint64_t> count(std::uint16_t code, std::uint64_t most) const {
        const std::unique_ptr<const Criterion> criterion = criterion_at_(bfloat16_value(code));
        return count_simplices<dimension>(levels_, *criterion, bounds_.bounds, most, options_,
                                          executor_);
    }

    /// Counts the triangles at a threshold and, where they keep within the budget, notes it as the
    /// best so far. \return whether they do
    bool fits(std::uint16_t code) {
        const auto triangles = count(code, max_triangles_);
        ++best_.trials;
        best_.extracted += triangles.value_or(max_triangles_ + 1);
        if (triangles) {
            best_.threshold = bfloat16_value(code);
            best_.triangles = *triangles;
        }
        return triangles.has_value();
    }

    [[noreturn]] void throw_too_few(std::uint16_t coarsest) const {
        const auto triangles = count(coarsest, std::numeric_limits<std::uint64_t>::max());
        throw InvalidInput("even the coarsest surface has more than " +
                           std::to_string(max_triangles_) +
                           " triangles: " + std::to_string(*triangles));
    }

    const Levels<Real>& levels_;
    const MakeCriterion& criterion_at_;
    SearchBounds bounds_;
    std::uint64_t max_triangles_;
    const IsosurfaceOptions& options_;
    const Executor& executor_;
    TriangleBudget best_;
};

}  // namespace

template <int dimension, class Real>
TriangleBudget find_threshold(const Levels<Real>& levels, const MakeCriterion& criterion_at,
                              const SearchBounds& bounds, std::uint64_t max_triangles,
                              const IsosurfaceOptions& options, const Executor& executor) {
    return BudgetSearch<dimension, Real>(levels, criterion_at, bounds, max_triangles, options,
                                         executor)
        .run();
}

template <int dimension, class Real>
Threshold criterion_for(const Levels<Real>& levels, const HierarchicalIndicator& indicator,
                        const IsosurfaceOptions& options, const Executor& executor) {
    if (!(options.threshold >= 0)) throw InvalidInput("the threshold is negative or not a number");
    if (options.max_triangles == 0) return {&indicator, options.threshold};
    const MakeCriterion everywhere = [&](double threshold) {
        return std::make_unique<const Threshold>(&indicator, threshold);
    };
    const TriangleBudget best = find_threshold<dimension>(
        levels, everywhere, {indicator, indicator.greatest() - indicator.least()},
        options.max_triangles, options, executor);
    return {&indicator, best.threshold};
}

}  // namespace engine

namespace detail {

template <int dimension, class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, double isovalue,
                              const MakeCriterion& criterion_at, const SearchBounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor) {
    const auto levels = engine::isosurface_levels(hierarchy, std::span<const double>(&isovalue, 1));
    return engine::find_threshold<dimension>(levels, criterion_at, bounds, max_triangles, options,
                                             executor);
}

template <int dimension, class Real>
Threshold criterion_for(const Hierarchy<Real>& hierarchy, double isovalue,
                        const HierarchicalIndicator& indicator, const IsosurfaceOptions& options,
                        const Executor& executor) {
    const auto levels = engine::isosurface_levels(hierarchy, std::span<const double>(&isovalue, 1));
    return engine::criterion_for<dimension>(levels, indicator, options, executor);
}

}  // namespace detail

#define NESTGRID_INSTANTIATE(dimension, Real)                                                      \
    template TriangleBudget engine::find_threshold<dimension>(                                     \
        const engine::Levels<Real>&, const detail::MakeCriterion&, const detail::SearchBounds&,    \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);                                 \
    template Threshold engine::criterion_for<dimension>(                                           \
        const engine::Levels<Real>&, const HierarchicalIndicator&, const IsosurfaceOptions&,       \
        const Executor&);                                                                          \
    template TriangleBudget detail::find_threshold<dimension>(                                     \
        const Hierarchy<Real>&, double, const detail::MakeCriterion&, const detail::SearchBounds&, \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);                                 \
    template Threshold detail::criterion_for<dimension>(                                           \
        const Hierarchy<Real>&, double, const HierarchicalIndicator&, const IsosurfaceOptions&,    \
        const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
