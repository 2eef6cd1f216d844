// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a LevelSearch decides at every element, to be compiled into the walk that asks.
#pragma once

#include <algorithm>
#include <bit>

#include <level_sets/level_search.hpp>
#include <walk/corner_count.hpp>

namespace nestgrid::engine {

/// The least number of type Real that is not below a bound.
template <class Real>
NESTGRID_INLINE Real as_real(double bound) {
    if constexpr (sizeof(Real) == sizeof(double)) return bound;
    return detail::float_above(bound);
}

/// Whether a level of a component may pass through an element on which the component is within
/// `bound` of corner values, themselves in lo ... hi. Rounding is monotone: a difference within the
/// bound is never rounded beyond it.
/// \param also_below whether elements wholly inside are of interest, too
template <class Real>
NESTGRID_INLINE bool LevelSearch<Real>::of_interest(Real lo, Real hi, Real bound,
                                                    std::size_t component, bool also_below) const {
    for (const Level<Real>& level : levels_) {
        if (level.component == component && level.least_inside - hi <= bound &&
            (also_below || lo - level.greatest_outside <= bound)) {
            return true;
        }
    }
    return false;
}

/// The least and the greatest value of a component at the corners.
template <class Real>
NESTGRID_INLINE auto LevelSearch<Real>::range_of(const View& view, std::size_t component) const
    -> Range {
    const Real* const value = view.value + component;
    Range range{value[0], value[0]};
    for (std::size_t i = 1; i < view.corner_count(); ++i) {
        const Real v = value[i * components_];
        range.lo = std::min(range.lo, v);
        range.hi = std::max(range.hi, v);
    }
    return range;
}

/// Whether a level of one component may pass through an element.
/// \param bound how far the data may leave the range of their corner values
template <class Real>
NESTGRID_INLINE bool LevelSearch<Real>::looks_at(const View& view, const Split& split,
                                                 std::size_t component, Real bound,
                                                 bool caps) const {
    if (component < functions_) return looks_at_function(view, split, component, caps);
    const Range range = range_of(view, component);
    return of_interest(range.lo, range.hi, bound, component, caps);
}

/// The least and the greatest value at the corners of an element, where there is one component.
template <class Real>
NESTGRID_INLINE auto LevelSearch<Real>::plain_range_of(const View& view) const -> Range {
    return with_corner_count(view.shape, [&](auto corners) NESTGRID_INLINE_LAMBDA {
        Range range{view.value[0], view.value[0]};
        for (std::size_t i = 1; i < corners; ++i) {
            range.lo = std::min(range.lo, view.value[i]);
            range.hi = std::max(range.hi, view.value[i]);
        }
        return range;
    });
}

/// The nodes among some at which the indicator is at most the threshold, one bit each.
template <class Real>
NESTGRID_INLINE NodeMask LevelSearch<Real>::low_nodes(std::span<const NodeKey> nodes) const {
    NodeMask mask = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        mask |= NodeMask{entries_->at(nodes[i]).stop <= most_} << i;
    }
    return mask;
}

/// look() where looks_plainly_. Looks up stop and bound of a node at once.
template <class Real>
NESTGRID_INLINE auto LevelSearch<Real>::look_plainly(const View& view, const Split& split) const
    -> Sight {
    const Rule& rule = *split.rule;
    const Level<Real>& level = levels_[0];
    const Range range = plain_range_of(view);
    const bool has_inside = rule.inside != no_new_node;
    NodeMask low = 0;
    std::uint16_t greatest = 0;
    if (has_inside) {  // the node inside has the greatest numbers
        const detail::IndicatorEntry entry = entries_->at(split.keys[rule.inside]);
        greatest = entry.bound;
        low = entry.stop <= most_ ? rule.all() : NodeMask{0};
    } else {
        for (std::size_t i = 0; i < split.keys.size(); ++i) {
            const detail::IndicatorEntry entry = entries_->at(split.keys[i]);
            greatest = std::max(greatest, entry.bound);
            low |= NodeMask{entry.stop <= most_} << i;
        }
    }
    const Real bound = std::max(static_cast<Real>(detail::bfloat16_value(greatest)),
                                static_cast<Real>(view.inner_bounds().beyond));
    if (!(level.least_inside - range.hi <= bound && range.lo - level.greatest_outside <= bound)) {
        return {{Visit::skip, 0}, bound};
    }
    if (stops_by_saturation(saturated_, view, split)) return {{Visit::stop, rule.all()}, bound};
    if (has_inside && low == 0) low = low_nodes(split.keys);
    low &= ~split.outside;
    return {{low == rule.all() ? Visit::stop : Visit::descend, low}, bound};
}

template <class Real>
NESTGRID_INLINE auto LevelSearch<Real>::look(const View& view, const Split& split, bool caps,
                                             CriterionQuestion& question) const -> Sight {
    const Rule* const rule = split.rule;
    if (looks_plainly_ && rule != nullptr && !caps) return look_plainly(view, split);
    return look_anyhow(view, split, caps, question);
}

template <class Real>
auto LevelSearch<Real>::look_anyhow(const View& view, const Split& split, bool caps,
                                    CriterionQuestion& question) const -> Sight {
    const Rule* const rule = split.rule;
    if (rule != nullptr && entries_ != nullptr) engine::prefetch(*entries_, *rule, split.keys);
    // P_S U of an element that is walked lies within U's own range there, but for `beyond`.
    const Real bound = rule == nullptr ? Real(0)
                                       : std::max(bound_of(*rule, split.keys),
                                                  static_cast<Real>(view.inner_bounds().beyond));
    bool interest = looks_at(view, split, 0, bound, caps);
    for (std::size_t component = 1; !interest && component <= last_component_; ++component) {
        interest = looks_at(view, split, component, bound, caps);
    }
    if (!interest) return {{Visit::skip, 0}, bound};
    if (rule == nullptr) return {{Visit::stop, 0}, bound};
    if (stops_by_saturation(saturated_, view, split)) {
        return {{Visit::stop, rule->all()}, bound};
    }
    if (!asks_for_masks_) return {question.ask(*walk_, *criterion_, view, split), bound};
    const NodeMask interpolated = holds({*rule, split.keys, view.level + 1, split.outside});
    return {{interpolated == rule->all() ? Visit::stop : Visit::descend, interpolated}, bound};
}

template <class Real>
NESTGRID_INLINE Leaves LevelSearch<Real>::cut_leaves(const Rule& rule, const Real* values,
                                                     NodeMask which) const {
    const std::size_t nodes = topology(rule.parent).corners + rule.new_nodes.size();
    NodeMask of_interest = 0;
    NodeMask lie_in = 0;
    for (const Level<Real>& level : levels_) {
        if (nodes > 64) {
            of_interest |= cut_children(rule, values, level);
            if (is_slice(level)) lie_in = which;
            continue;
        }
        const Real* const value = values + level.component;
        std::uint64_t inside = 0;
        std::uint64_t at_level = 0;
        for (std::size_t n = 0; n < nodes; ++n) {
            inside |= std::uint64_t{value[n * components_] >= level.least_inside} << n;
        }
        for (std::size_t n = 0; is_slice(level) && n < nodes; ++n) {
            at_level |= std::uint64_t{value[n * components_] == level.least_inside} << n;
        }
        for (NodeMask left = which; left != 0; left &= left - 1) {
            const auto c = static_cast<std::size_t>(std::countr_zero(left));
            const std::uint64_t all = rule.children[c].nodes;
            const bool cut = ((all & inside) != 0) & ((all & ~inside) != 0);
            of_interest |= NodeMask{cut} << c;
            if (at_level == 0) continue;
            lie_in |= std::popcount(all & at_level) >= 3 ? left & ~(left - 1) : NodeMask{0};
        }
    }
    return {of_interest & which, lie_in & which & ~of_interest};
}

/// How far a component may leave the range of the corner values on an element with these new nodes.
template <class Real>
NESTGRID_INLINE Real LevelSearch<Real>::bound_of(const Rule& rule,
                                                 std::span<const NodeKey> nodes) const {
    return as_real<Real>(own_bounds_ != nullptr ? own_bounds_->bound(rule, nodes)
                                                : bounds_->bound(rule, nodes));
}

template <class Real>
NodeMask LevelSearch<Real>::holds(const NewNodes& nodes) const {
    if (own_threshold_ == nullptr) return criterion_->holds(nodes);
    return own_bounds_->stops_at_most(nodes.rule, nodes.keys, own_threshold_->epsilon()) &
           ~nodes.outside;
}

}  // namespace nestgrid::engine
