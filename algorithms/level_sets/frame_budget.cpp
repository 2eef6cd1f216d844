// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/frame_budget.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <drawing/bfloat16_search.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

constexpr double finest = 1.0 / 65536;  // of the greatest threshold
// Binary logarithms of cost / goal, and of the least change of the threshold that says more about
// the cost than the motion does.
constexpr double greatest_miss = 4;
constexpr double least_move = 0.015;
// The cost is about threshold^-power: 1 for surfaces whose error is the threshold.
constexpr double least_power = 0.5;
constexpr double greatest_power = 16;

double positive(double x, const char* what) {
    if (!(x > 0) || !std::isfinite(x)) {
        throw InvalidInput(std::string("the ") + what + " is not a positive finite number");
    }
    return x;
}

using engine::Bracket;
using engine::octave;

/// Goes down from a code that fits in steps that double up to an octave, and from `least` to 0.
template <class Fits>
Bracket bracket_below(std::uint16_t within, std::uint16_t least, Fits&& fits) {
    for (int step = 1; within > 0; step = std::min(2 * step, octave)) {
        const auto lower = static_cast<std::uint16_t>(within - step > least ? within - step : 0);
        if (!fits(lower)) return {lower, within};
        within = lower;
    }
    return {within, within};
}

/// Doubles steps upwards from a code that does not fit. Returns {last, last} where none fits.
template <class Fits>
Bracket bracket_above(std::uint16_t beyond, std::uint16_t last, Fits&& fits) {
    for (int step = 1; beyond < last; step = std::min(2 * step, octave)) {
        const auto upper = static_cast<std::uint16_t>(std::min(beyond + step, int{last}));
        if (fits(upper)) return {beyond, upper};
        beyond = upper;
    }
    return {last, last};
}

}  // namespace

FrameBudget::FrameBudget(double goal, double greatest)
    : goal_{positive(goal, "goal of a frame budget")},
      greatest_{positive(greatest, "greatest threshold of a frame budget")},
      threshold_{greatest_ / 8},
      last_{std::log2(threshold_), 0} {}

double FrameBudget::threshold() const { return threshold_ > finest * greatest_ ? threshold_ : 0; }

void FrameBudget::aim(double goal) { goal_ = positive(goal, "goal of a frame budget"); }

void FrameBudget::drawn(double cost) {
    if (!(cost >= 0)) throw InvalidInput("the cost of a frame is negative or not a number");
    const Frame frame{std::log2(threshold_),
                      std::clamp(std::log2(cost / goal_), -greatest_miss, greatest_miss)};
    const double moved = frame.threshold - last_.threshold;
    const double fallen = last_.miss - frame.miss;
    if (std::abs(moved) > least_move && fallen * moved > 0) {
        const double power = fallen / moved;
        power_ = std::clamp(std::sqrt(power_ * power), least_power, greatest_power);
    }
    last_ = frame;
    const double step = std::clamp(frame.miss / power_, -1.0, 1.0);
    threshold_ = std::clamp(threshold_ * std::exp2(step), finest * greatest_, greatest_);
}

double FrameBudget::settle(const std::function<bool(double)>& fits) {
    const std::uint16_t last = detail::bfloat16_above(detail::float_above(greatest_));
    const auto value = [&](std::uint16_t code) {
        return code < last ? static_cast<double>(detail::bfloat16_value(code)) : greatest_;
    };
    const auto code_fits = [&](std::uint16_t code) {
        const bool fit = fits(value(code));
        kept_ = kept_ || fit;
        return fit;
    };
    kept_ = false;
    const auto start = std::min(detail::bfloat16_above(detail::float_above(threshold())), last);
    const std::uint16_t least = detail::bfloat16_above(detail::float_above(finest * greatest_));
    const Bracket bracket = code_fits(start) ? bracket_below(start, least, code_fits)
                                             : bracket_above(start, last, code_fits);
    const double found = value(engine::least_that_fits(bracket.beyond, bracket.within, code_fits));
    threshold_ = std::max(found, finest * greatest_);
    return found;
}

}  // namespace nestgrid
