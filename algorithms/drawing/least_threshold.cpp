// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/least_threshold.hpp>

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>

#include <drawing/bfloat16_search.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/error.hpp>
#include <walk/frontier.hpp>

namespace nestgrid {

namespace {

using engine::Bracket;
using engine::octave;

/// The code of the greatest finite threshold. Nodes outside of the domain have the indicator
/// infinity, and no element may stop at them.
constexpr std::uint16_t greatest_code = detail::bfloat16_infinity - 1;

std::string short_number(double x) {
    std::ostringstream text;
    text << x;
    return text.str();
}

/// After so many halvings of the threshold, steps double: what is then left is of data that are
/// affine up to rounding, say.
constexpr int halvings = 8;

/// Triangles beyond the budget are counted up to so many times the budget.
constexpr std::uint64_t most_beyond = 16;

/// Tries thresholds by their codes, and keeps the last one that fits.
class Trials {
public:
    Trials(const CountTriangles& count, std::uint64_t max_triangles, std::uint16_t least)
        : count_{count}, max_triangles_{max_triangles}, least_{least} {
        best_.max_triangles = max_triangles;
        best_.least = detail::bfloat16_value(least);
    }

    const TriangleBudget& best() const { return best_; }
    bool any_fits() const { return any_fits_; }

    bool fits(std::uint16_t code) {
        const double threshold = detail::bfloat16_value(code);
        const auto triangles = count_(threshold, max_triangles_);
        ++best_.trials;
        best_.extracted += triangles.value_or(max_triangles_ + 1);
        if (triangles) {
            best_.threshold = threshold;
            best_.triangles = *triangles;
            any_fits_ = true;
        }
        return triangles.has_value();
    }

    /// Requires: `within` fits, and 0 does not. A least threshold above 0 is tried last: a drawing
    /// at it may be far larger than the budget.
    Bracket bracket_below(std::uint16_t within) {
        int step = octave;
        for (int trial = 0; within > least_ + step; ++trial) {
            const auto code = static_cast<std::uint16_t>(within - step);
            if (!fits(code)) return {code, within};
            within = code;
            if (trial >= halvings && least_ == 0) step *= 2;
        }
        if (least_ > 0 && (within == least_ || fits(least_))) return {least_, least_};
        return {least_, within};
    }

    /// Requires: `beyond` does not fit. Tries the greatest threshold first, because where that does
    /// not fit, all other trials would be in vain.
    Bracket bracket_above(std::uint16_t beyond) {
        if (beyond == greatest_code || !fits(greatest_code)) throw_too_few();
        for (int step = octave; beyond + step < greatest_code; step *= 2) {
            const auto code = static_cast<std::uint16_t>(beyond + step);
            if (fits(code)) return {beyond, code};
            beyond = code;
        }
        return {beyond, greatest_code};
    }

    /// Counts the triangles at the next lesser threshold, where the budget is far from filled.
    void look_beyond(std::uint16_t code) {
        if (best_.end() != BudgetEnd::step) return;
        best_.next_threshold = detail::bfloat16_value(code);
        best_.next_triangles =
            count_(best_.next_threshold, most_beyond * max_triangles_).value_or(0);
    }

private:
    [[noreturn]] void throw_too_few() const {
        const auto triangles = count_(detail::bfloat16_value(greatest_code),
                                      std::numeric_limits<std::uint64_t>::max());
        throw InvalidInput("even the coarsest surface has more than " +
                           std::to_string(max_triangles_) +
                           " triangles: " + std::to_string(triangles.value()));
    }

    const CountTriangles& count_;
    std::uint64_t max_triangles_;
    std::uint16_t least_;
    TriangleBudget best_;
    bool any_fits_ = false;
};

std::uint16_t code_above(double threshold) {
    return std::min(detail::bfloat16_above(detail::float_above(std::max(threshold, 0.0))),
                    greatest_code);
}

void search(Trials& trials, double start, std::uint16_t least) {
    if (least == 0 && trials.fits(0)) return;
    const std::uint16_t first = std::max(code_above(start), least);
    const Bracket bracket =
        first > 0 && trials.fits(first) ? trials.bracket_below(first) : trials.bracket_above(first);
    const std::uint16_t found = engine::least_that_fits(
        bracket.beyond, bracket.within, [&](std::uint16_t code) { return trials.fits(code); });
    trials.look_beyond(static_cast<std::uint16_t>(found - 1));
}

}  // namespace

BudgetEnd TriangleBudget::end() const {
    if (cancelled) return BudgetEnd::cancelled;
    if (threshold <= least) return BudgetEnd::complete;
    const bool filled = triangles >= max_triangles - max_triangles / 10;
    return filled ? BudgetEnd::filled : BudgetEnd::step;
}

std::string TriangleBudget::reason() const {
    const std::string of =
        std::to_string(triangles) + " of " + std::to_string(max_triangles) + " triangles";
    switch (end()) {
        case BudgetEnd::filled:
            return {};
        case BudgetEnd::complete:
            return least == 0 ? of + ": nothing is left out"
                              : of + ": no error below " + short_number(least) + " is tried";
        case BudgetEnd::step:
            return of +
                   (least == 0
                        ? ": many elements share one indicator, and the next lesser threshold, "
                        : ": many elements are halved at one error, and the next lesser one, ") +
                   short_number(next_threshold) + ", has " +
                   (next_triangles == 0 ? "more than " + std::to_string(most_beyond * max_triangles)
                                        : std::to_string(next_triangles));
        case BudgetEnd::cancelled:
            return of + ": the search was cancelled";
    }
    return {};
}

TriangleBudget least_threshold(const CountTriangles& count, double start,
                               std::uint64_t max_triangles, double least) {
    const std::uint16_t least_code = code_above(least);
    Trials trials(count, max_triangles, least_code);
    try {
        search(trials, start, least_code);
        return trials.best();
    } catch (const engine::Cancelled&) {
        TriangleBudget best = trials.best();
        best.cancelled = true;
        if (!trials.any_fits()) best.threshold = detail::bfloat16_value(greatest_code);
        return best;
    }
}

}  // namespace nestgrid
