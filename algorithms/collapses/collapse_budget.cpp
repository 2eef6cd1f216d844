// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/collapse_budget.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <distances/box_tree.hpp>
#include <drawing/bfloat16_search.hpp>
#include <level_sets/draw.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/error.hpp>
#include <projection/by_criterion.hpp>
#include <walk/frontier.hpp>

namespace nestgrid::engine {

namespace {

constexpr int guesses = 6;         // trials, before intervals are halved and steps doubled
constexpr double aim = 0.95;       // part of the number that a trial is to have
constexpr double steepness = 1.2;  // triangles are about amount^-steepness
constexpr int least_step = 8;      // of codes, beyond what was tried
constexpr int most_step = 4 * octave;
constexpr int octaves_tried = 24;   // of errors, below the greatest one
constexpr int octaves_begun = 6;    // below it, where nothing is known
constexpr std::uint64_t taken = 8;  // triangles that collapses make one of, about

/// An error or a distance by its bfloat16 code, and the triangles that it leaves.
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

/// Tries amounts, be they errors or distances, and keeps the last one that fits.
class AmountSearch {
public:
    /// Draws and collapses within an amount, adds the triangles that it drew to a number, and
    /// returns how many are left.
    using Collapse = std::function<std::uint64_t(double amount, std::uint64_t& drawn)>;

    AmountSearch(Collapse collapse, std::uint64_t max_triangles) : collapse_{std::move(collapse)} {
        best_.max_triangles = max_triangles;
    }

    /// \param all the triangles of all data
    /// \param first first() is the amount to begin with, where these are too many
    /// \param least_amount that is tried
    /// \param greatest amount at which the surface is as coarse as it gets
    /// \throw InvalidInput where no amount keeps within the number
    template <class First>
    void run(std::uint64_t all, const First& first, double least_amount, double greatest) {
        if (all <= best_.max_triangles) {
            best_.triangles = all;
            return;
        }
        best_.next_triangles = all;
        const int most = code_of(greatest);
        const int least = std::max(1, code_of(least_amount));
        int code = std::clamp(code_of(first()), least, most);
        while (true) {
            attempt(code);
            const int next_below = beyond_ ? beyond_->code + 1 : least;
            if (within_ && (best_.end() == BudgetEnd::filled || within_->code <= next_below))
                return;
            if (!within_ && code == most) break;
            const auto number = static_cast<double>(best_.max_triangles);
            code = std::clamp(next_code(beyond_, within_, number, best_.trials), least, most);
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
    static int code_of(double amount) {
        return detail::bfloat16_above(detail::float_above(amount));
    }

    void attempt(int code) {
        const double amount = detail::bfloat16_value(static_cast<std::uint16_t>(code));
        const std::uint64_t triangles = collapse_(amount, best_.extracted);
        ++best_.trials;
        if (triangles <= best_.max_triangles) {
            within_ = {code, triangles};
            best_.threshold = amount;
            best_.triangles = triangles;
        } else {
            beyond_ = {code, triangles};
            best_.next_threshold = amount;
            best_.next_triangles = triangles;
        }
    }

    Collapse collapse_;
    TriangleBudget best_;
    std::optional<Trial> beyond_;  // the greatest amount that exceeds the number
    std::optional<Trial> within_;  // the least one that keeps within it
};

/// \param run searches, and throws Cancelled where progress ends that
template <class Run>
TriangleBudget found_by(AmountSearch& search, const Run& run) {
    try {
        run();
        return search.best(false);
    } catch (const Cancelled&) {
        return search.best(true);
    }
}

/// Options of surfaces whose triangles alone are counted.
IsosurfaceOptions of_trials(IsosurfaceOptions options) {
    options.normals = options.cap = options.elements = options.reference = false;
    return options;
}

/// \throw Cancelled where progress has ended the drawing
Surface<3>& complete(Isosurface<3>& drawn) {
    if (drawn.cancelled) throw Cancelled{};
    return drawn.surface;
}

/// An error at which so many triangles are drawn that collapses may leave the number.
/// \param drawn drawn(error, most): the triangles at collapse_start of it, if they are no more
template <class DrawnAt>
double first_error(const DrawnAt& drawn, double range, std::uint64_t all, std::uint64_t max) {
    const std::uint64_t most = taken * max;
    const double least = std::ldexp(range, all > most ? -octaves_tried : -5);
    double error = range;
    while (error > least && (all <= most || drawn(collapse_start * error, most))) error /= 2;
    return error;
}

/// Twice the range of the data, at which nothing but the shape is left to be kept, or any error
/// where the data are constant.
double greatest_error(double range) { return range > 0 ? 2 * range : 1; }

/// A part of the length of an edge where that many triangles are of one size.
double first_distance(const Surface<3>& whole, std::uint64_t max_triangles) {
    return 0.2 * std::sqrt(surface_report(whole).area / static_cast<double>(max_triangles));
}

}  // namespace

template <class Real>
TriangleBudget find_collapse_error(const Hierarchy<Real>& hierarchy, double isovalue,
                                   const CriterionAt& criterion_at, const Bounds& bounds,
                                   std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                   const Executor& executor) {
    hierarchy.facts().require_one_process("a number of triangles after collapses");
    const IsosurfaceOptions of_trial = of_trials(options);
    const auto collapse_within = [&](double error, std::uint64_t& triangles) {
        Isosurface<3> result = isosurface<3>(
            hierarchy, isovalue, criterion_at(collapse_start * error), bounds, of_trial, executor);
        Surface<3>& surface = complete(result);
        triangles += surface.simplices.size();
        collapse(surface, hierarchy, isovalue, bounds, {.error = error}, executor);
        return surface.simplices.size();
    };
    AmountSearch search(collapse_within, max_triangles);
    return found_by(search, [&] {
        const auto levels = isosurface_levels(hierarchy, std::span<const double>(&isovalue, 1));
        const auto drawn = [&](double threshold, std::uint64_t most) {
            return count_simplices<3>(levels, criterion_at(threshold), bounds, most, of_trial,
                                      executor);
        };
        const std::uint64_t all = drawn(0, std::numeric_limits<std::uint64_t>::max()).value();
        const double range = bounds.greatest() - bounds.least();
        const auto first = [&] { return first_error(drawn, range, all, max_triangles); };
        const double greatest = greatest_error(range);
        search.run(all, first, std::ldexp(greatest, -octaves_tried), greatest);
    });
}

template <class Real>
TriangleBudget find_collapse_distance(const Hierarchy<Real>& hierarchy, double isovalue,
                                      const Surface<3>& whole, const CriterionAt& criterion_at,
                                      const Bounds& bounds, std::uint64_t max_triangles,
                                      const IsosurfaceOptions& options, const Executor& executor) {
    const IsosurfaceOptions of_trial = of_trials(options);
    const auto collapse_within = [&](double distance, std::uint64_t& triangles) {
        const double first = distance / 2;
        Isosurface<3> result = isosurface_within(hierarchy, isovalue, {whole, first},
                                                 criterion_at(first), bounds, of_trial, executor)
                                   .isosurface;
        Surface<3>& surface = complete(result);
        triangles += surface.simplices.size();
        collapse(surface, hierarchy, isovalue, bounds, {.nearness = Nearness{whole, distance}},
                 executor);
        return surface.simplices.size();
    };
    AmountSearch search(collapse_within, max_triangles);
    return found_by(search, [&] {
        const double first = first_distance(whole, max_triangles);
        search.run(
            whole.simplices.size(), [&] { return first; }, first / 4,
            Box::around(whole.vertices).diameter());
    });
}

TriangleBudget find_collapse_error(const TryCollapse& within, double range,
                                   std::uint64_t max_triangles) {
    const auto attempt = [&](double error) {
        const std::optional<CollapseTrial> trial = within(error);
        if (!trial) throw Cancelled{};
        return *trial;
    };
    const auto collapse_within = [&](double error, std::uint64_t& triangles) {
        const CollapseTrial trial = attempt(error);
        triangles += trial.drawn;
        return trial.left;
    };
    AmountSearch search(collapse_within, max_triangles);
    return found_by(search, [&] {
        const double greatest = greatest_error(range);
        search.run(
            attempt(0).left, [&] { return std::ldexp(greatest, -octaves_begun); },
            std::ldexp(greatest, -octaves_tried), greatest);
    });
}

#define NESTGRID_INSTANTIATE(Real)                                                                \
    template TriangleBudget find_collapse_error(const Hierarchy<Real>&, double,                   \
                                                const CriterionAt&, const Bounds&, std::uint64_t, \
                                                const IsosurfaceOptions&, const Executor&);       \
    template TriangleBudget find_collapse_distance(                                               \
        const Hierarchy<Real>&, double, const Surface<3>&, const CriterionAt&, const Bounds&,     \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
