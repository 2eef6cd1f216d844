// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// How an indicator spreads from finer nodes to coarser ones, in bfloat16.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

/// \throw InvalidInput where the factor is below 1 or the slope below 0, or one is not finite
inline void require_spread(const Spread& spread) {
    if (spread.factor >= 1 && spread.slope >= 0 && std::isfinite(spread.factor) &&
        std::isfinite(spread.slope)) {
        return;
    }
    throw InvalidInput(
        "an indicator is spread by a factor of at least 1 and a slope of at least 0, not by " +
        std::to_string(spread.factor) + " and " + std::to_string(spread.slope));
}

/// How far a split hands an indicator on: the greatest distance, rounded up, between a new node and
/// a corner, or another new node where one of them may be a parent.
/// \param x positions of the corners and, behind them, of the new nodes
inline float reach_of(const Rule& rule, std::span<const Point> x) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    double greatest = 0;
    for (const Point& parent : x.first(rule.steps == 1 ? corners : x.size())) {
        for (const Point& made : x.subspan(corners)) {
            greatest = std::max(greatest, norm(made - parent));
        }
    }
    return detail::float_above(greatest);
}

/// factor * (stop + slope * reach), rounded up.
inline std::uint16_t hand_on(const Spread& spread, std::uint16_t stop, float reach) {
    if (spread.factor == 1 && spread.slope == 0) return stop;
    const double to = static_cast<double>(detail::bfloat16_value(stop)) + spread.slope * reach;
    return detail::bfloat16_above(detail::float_above(spread.factor * to));
}

}  // namespace nestgrid::engine
