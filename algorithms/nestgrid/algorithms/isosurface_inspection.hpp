// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which elements a level may pass through, and what to do with them; included by
// isosurface_steps.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

/// Whether a level may pass through an element on which U is within `bound` of corner values,
/// themselves in lo ... hi. Rounding is monotone: a difference within the bound is never rounded
/// beyond it.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE bool IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::of_interest(
    Real lo, Real hi, Real bound, bool also_below) const {
    for (const Layer& layer : layers_) {
        if (layer.least_inside - hi <= bound &&
            (also_below || lo - layer.greatest_outside <= bound)) {
            return true;
        }
    }
    return false;
}

NESTGRID_VISITOR::inspect(const State& s, const Split& split) -> Decision {
    ++counts_.calls;
    if ((counts_.calls & 0xFFFFU) == 0) tick(0, 0);
    if (finishing_ && s.father == nullptr && enter_->find(s.path) == nullptr) {
        return {Visit::skip, 0};
    }
    const Decision decision = look(s, split);
    counts_.visited += decision.visit != Visit::skip;
    return decision;
}

/// Those with corners on both sides of a level.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE NodeMask IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::leaves_of_interest(
    const Rule& rule, std::span<const Real> values) const {
    constexpr Shape only = only_shape<Grid>();
    const std::span<const Child> children(rule.children);
    NodeMask of_interest = 0;
    for (const Layer& layer : layers_) {
        for (std::size_t c = 0; c < children.size(); ++c) {
            const Topology& t = topology(only == Shape::point ? children[c].shape : only);
            unsigned inside = 0;
            for (std::size_t i = 0; i < t.corners; ++i) {
                const std::size_t node = children[c].corner[i];
                inside += values[node * State::components] >= layer.least_inside;
            }
            of_interest |= NodeMask{inside != 0 && inside != t.corners} << c;
        }
    }
    return of_interest;
}

NESTGRID_VISITOR::count_leaf(bool of_interest) -> void {
    ++counts_.calls;
    if ((counts_.calls & 0xFFFFU) == 0) tick(0, 0);
    counts_.visited += of_interest;
    element_bound_ = 0;
}

NESTGRID_VISITOR::count(std::uint64_t calls, std::uint64_t visited) -> void {
    counts_.calls += calls;
    counts_.visited += visited;
}

/// Reports the counts so far, and these.
NESTGRID_VISITOR::tick(std::uint64_t calls, std::uint64_t visited) const -> void {
    if (!options_->progress) return;
    TraversalCounts counts = counts_;
    counts.calls += calls;
    counts.visited += visited;
    if (!options_->progress(counts)) throw Cancelled{};
}

/// What to do with an element.
NESTGRID_VISITOR::look(const State& s, const Split& split) -> Decision {
    if constexpr (requires { indicator_->prefetch(*split.rule, split.keys); }) {
        if (split.rule != nullptr) indicator_->prefetch(*split.rule, split.keys);
    }
    Real lo = s.value[0];
    Real hi = lo;
    for (std::size_t i = 1; i < static_cast<std::size_t>(s.corner_count()); ++i) {
        const Real v = s.value[i * State::components];
        lo = std::min(lo, v);
        hi = std::max(hi, v);
    }
    element_bound_ = split.rule == nullptr ? Real(0) : bound_of(split);
    const bool capped = options_->cap && walk_->boundary(s) != 0;
    if (!of_interest(lo, hi, element_bound_, capped)) return {Visit::skip, 0};
    if (split.rule == nullptr) return {Visit::stop, 0};
    const NodeMask interpolated =
        (*criterion_)(NewNodes{*split.rule, split.keys, s.level + 1, split.outside});
    return {interpolated == split.rule->all() ? Visit::stop : Visit::descend, interpolated};
}

/// Not below the indicator's.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::bound_of(
    std::span<const NodeKey> nodes) const -> Real {
    return as_real(indicator_->bound(nodes));
}
NESTGRID_VISITOR::bound_of(const Split& split) const -> Real {
    if constexpr (requires { indicator_->bound(*split.rule, split.keys); }) {
        return as_real(indicator_->bound(*split.rule, split.keys));
    } else {
        return bound_of(split.keys);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
