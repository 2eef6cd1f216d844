// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values and positions of the new nodes of a split; included by traversal_steps.hpp.
#pragma once

#include <algorithm>
#include <bit>

#include <nestgrid/interpolate.hpp>
#include <nestgrid/traversal.hpp>

namespace nestgrid {

namespace detail {

/// \throw GridError where one of these new nodes of an element has no value
template <class State>
void require_no_missing(NodeMask missing, const State& s) {
    if (missing == 0) return;
    throw GridError("the field has no value at new node " +
                    std::to_string(std::countr_zero(missing)) + " of an element on level " +
                    std::to_string(s.level) + " below coarse element " + std::to_string(s.coarse));
}

}  // namespace detail

template <class Grid, class Field, Needs needs>
void Traversal<Grid, Field, needs>::project(const State& s, const Split& split,
                                            NodeMask interpolated, Real* value) const {
    constexpr std::size_t c_count = State::components;
    const Rule& rule = *split.rule;
    const auto corners = static_cast<std::size_t>(s.corner_count());
    std::copy_n(s.value.begin(), corners * c_count, value);
    const NodeMask mean = interpolated | split.constrained;
    const NodeMask which = rule.all() & ~mean;
    if (which != 0) {
        const NodeMask missing = detail::call_new_values(
            *field_, *s.context, s.element, which,
            std::span<Real>(value + corners * c_count, rule.new_nodes.size() * c_count));
        detail::require_no_missing(missing & which, s);
    }
    if ((mean & rule.all()) == 0) return;
    for (NodeMask left = mean & rule.all(); left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        std::ranges::copy(detail::interpolate<c_count>(rule.new_nodes[n], value, c_count),
                          value + (corners + n) * c_count);
    }
}

template <class Grid, class Field, Needs needs>
void Traversal<Grid, Field, needs>::project_positions(const State& s, const Split& split,
                                                      NodeMask interpolated,
                                                      Point* position) const {
    const Rule& rule = *split.rule;
    const auto corners = static_cast<std::size_t>(s.corner_count());
    if constexpr (State::carries_positions) std::copy_n(s.position.begin(), corners, position);
    NodeMask given = 0;
    if constexpr (may_offer<Grid>(Feature::new_positions)) {
        if (new_positions_) {
            given = rule.all() & ~(interpolated | split.constrained);
            detail::call_new_positions(*grid_, *s.context, s.element, given,
                                       std::span<Point>(position + corners, rule.new_nodes.size()));
        }
    }
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        if ((given >> n & 1U) == 0) {
            position[corners + n] = detail::interpolate(rule.new_nodes[n], position);
        }
    }
}

}  // namespace nestgrid
