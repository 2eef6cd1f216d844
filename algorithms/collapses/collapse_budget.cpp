// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/collapse_budget.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <levels/bfloat16_search.hpp>
#include <levels/draw.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/error.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::detail {

namespace {

using engine::octave;

constexpr int guesses = 6;         // trials, before intervals are halved and steps doubled
constexpr double aim = 0.95;       // part of the number that a trial is to have
constexpr double steepness = 1.2;  // triangles are about error^-steepness
constexpr int least_step = 8;      // of codes, beyond what was tried
constexpr int most_step = 4 * octave;
constexpr int octaves_tried = 24;   // below the range of the data
constexpr std::uint64_t taken = 8;  // triangles that collapses make one of, about

/// An error by its bfloat16 code, and the triangles that it leaves.
struct Trial {
    int code;
    std::uint64_t triangles;
};

/// The next code between or beyond those that were tried.
/// \param within keeps within the number; beyond does not
/// \param trials how many there were
int next_code(const std::optional<Trial>& beyond, const std::optional<Trial>& within, double number,
              int trials) {
    const double target = aim * number;
    const auto octaves = [&](std::uint64_t triangles) {
        return std::log2(std::max(static_cast<double>(triangles), 1.0) / target);
    };
    if (beyond && within) {
        const int between = within->code - beyond->code;
        if (trials >= guesses) return within->code - between / 2;
        const double below = -octaves(within->triangles);
        const double part = below / std::max(below + octaves(beyond->triangles), 1e-9);
        const int margin = std::max(1, between / 10);
        const auto step = static_cast<int>(std::lround(part * between));
        return within->code - std::clamp(step, margin, std::max(margin, between - margin));
    }
    const Trial& tried = beyond ? *beyond : *within;
    const double steps = octave / steepness * octaves(tried.triangles);
    const int least = least_step << std::min(trials, guesses);
    const int step = std::clamp(static_cast<int>(std::abs(steps)), least, most_step);
    return beyond ? tried.code + step : tried.code - step;
}

/// Tries errors, and keeps the last one that fits.
template <class Real>
class CollapseTrials {
public:
    CollapseTrials(const Hierarchy<Real>& hierarchy, double isovalue,
                   const MakeCriterion& criterion_at, const SearchBounds& bounds,
                   std::uint64_t max_triangles, IsosurfaceOptions options, const Executor& executor)
        : hierarchy_{hierarchy},
          isovalue_{isovalue},
          criterion_at_{criterion_at},
          bounds_{bounds},
          options_{std::move(options)},
          executor_{executor},
          levels_{engine::isosurface_levels(hierarchy, std::span<const double>(&isovalue, 1))} {
        best_.max_triangles = max_triangles;
        options_.normals = options_.cap = options_.elements = options_.reference = false;
    }

    /// \throw InvalidInput where no error keeps within the number
    void run() {
        const std::uint64_t all = drawn(0, std::numeric_limits<std::uint64_t>::max()).value();
        if (all <= best_.max_triangles) {
            best_.triangles = all;
            return;
        }
        best_.next_triangles = all;
        const int greatest = code_of(2 * bounds_.range);
        const int least = std::max(1, greatest - octaves_tried * octave);
        int code = std::clamp(code_of(first_error(all)), least, greatest);
        while (true) {
            attempt(code);
            const int next_below = beyond_ ? beyond_->code + 1 : least;
            if (within_ && (best_.end() == BudgetEnd::filled || within_->code <= next_below))
                return;
            if (!within_ && code == greatest) break;
            const auto number = static_cast<double>(best_.max_triangles);
            code = std::clamp(next_code(beyond_, within_, number, best_.trials), least, greatest);
        }
        throw InvalidInput("even the coarsest surface has more than " +
                           std::to_string(best_.max_triangles) +
                           " triangles after collapses: " + std::to_string(best_.next_triangles));
    }
    TriangleBudget best(bool cancelled) {
        best_.cancelled = cancelled;
        return best_;
    }

private:
    static int code_of(double error) { return bfloat16_above(float_above(error)); }

    /// How many triangles are drawn at a threshold, or nothing where there are more than `most`.
    std::optional<std::uint64_t> drawn(double threshold, std::uint64_t most) const {
        return engine::count_simplices<3>(levels_, *criterion_at_(threshold), bounds_.bounds, most,
                                          options_, executor_);
    }
    /// An error at which so many triangles are drawn that collapses may leave the number.
    double first_error(std::uint64_t all) const {
        const std::uint64_t most = taken * best_.max_triangles;
        const double least = std::ldexp(bounds_.range, all > most ? -octaves_tried : -5);
        double error = bounds_.range;
        while (error > least && (all <= most || drawn(collapse_start * error, most))) error /= 2;
        return error;
    }
    void attempt(int code) {
        const double error = bfloat16_value(static_cast<std::uint16_t>(code));
        Isosurface<3> result =
            isosurface<3>(hierarchy_, isovalue_, *criterion_at_(collapse_start * error), bounds_.bounds,
                          options_, executor_);
        if (result.cancelled) throw engine::Cancelled{};
        Surface<3>& surface = result.surface;
        best_.extracted += surface.simplices.size();
        ++best_.trials;
        collapse(surface, hierarchy_, isovalue_, bounds_.bounds, {.error = error}, executor_);
        const std::uint64_t triangles = surface.simplices.size();
        if (triangles <= best_.max_triangles) {
            within_ = {code, triangles};
            best_.threshold = error;
            best_.triangles = triangles;
        } else {
            beyond_ = {code, triangles};
            best_.next_threshold = error;
            best_.next_triangles = triangles;
        }
    }

    const Hierarchy<Real>& hierarchy_;
    double isovalue_;
    const MakeCriterion& criterion_at_;
    SearchBounds bounds_;
    IsosurfaceOptions options_;
    const Executor& executor_;
    engine::Levels<Real> levels_;
    TriangleBudget best_;
    std::optional<Trial> beyond_;  // the greatest error that exceeds the number
    std::optional<Trial> within_;  // the least one that keeps within it
};

}  // namespace

template <class Real>
TriangleBudget find_collapse_error(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const MakeCriterion& criterion_at, const SearchBounds& bounds,
                                   std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                   const Executor& executor) {
    CollapseTrials<Real> trials(hierarchy, isovalue, criterion_at, bounds, max_triangles, options,
                                executor);
    try {
        trials.run();
        return trials.best(false);
    } catch (const engine::Cancelled&) {
        return trials.best(true);
    }
}

template TriangleBudget find_collapse_error(const Hierarchy<float>&, double, const MakeCriterion&,
                                            const SearchBounds&, std::uint64_t,
                                            const IsosurfaceOptions&, const Executor&);
template TriangleBudget find_collapse_error(const Hierarchy<double>&, double, const MakeCriterion&,
                                            const SearchBounds&, std::uint64_t,
                                            const IsosurfaceOptions&, const Executor&);

}  // namespace nestgrid::detail
