// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that decide which elements a level set may pass through.
#pragma once

#include <bit>

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

/// Whether a level may pass through an element on which U is within `bound` of corner values,
/// themselves in lo ... hi. Rounding is monotone: a difference within the bound is never rounded
/// beyond it.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE bool IsosurfaceVisitor<dimension, Real, indexed>::of_interest(
    Real lo, Real hi, Real bound, bool also_below) const {
    for (const Layer& layer : layers_) {
        if (layer.least_inside - hi <= bound &&
            (also_below || lo - layer.greatest_outside <= bound)) {
            return true;
        }
    }
    return false;
}

template <int dimension, class Real, bool indexed>
Decision IsosurfaceVisitor<dimension, Real, indexed>::inspect(const View& s, const Split& split) {
    ++counts_.calls;
    if ((counts_.calls & 0xFFFFU) == 0) tick(0, 0);
    if (finishing_ && s.father == nullptr && enter_->find(s.path) == nullptr) {
        return {Visit::skip, 0};
    }
    const Decision decision = look(s, split);
    counts_.visited += decision.visit != Visit::skip;
    return decision;
}

/// The children with corners on both sides of a level, one bit each.
/// \param which the children to be looked at
template <int dimension, class Real, bool indexed>
NodeMask IsosurfaceVisitor<dimension, Real, indexed>::leaves_of_interest(const Rule& rule,
                                                                         const Real* values,
                                                                         NodeMask which) const {
    const std::size_t nodes = topology(rule.parent).corners + rule.new_nodes.size();
    NodeMask of_interest = 0;
    for (const Layer& layer : layers_) {
        if (nodes > 64) {
            of_interest |= cut_children(rule, values, layer.least_inside);
            continue;
        }
        std::uint64_t inside = 0;
        for (std::size_t n = 0; n < nodes; ++n) {
            inside |= std::uint64_t{values[n * components_] >= layer.least_inside} << n;
        }
        for (NodeMask left = which; left != 0; left &= left - 1) {
            const std::uint64_t all = rule.children[std::countr_zero(left)].nodes;
            const bool cut = (all & inside) != 0 && (all & ~inside) != 0;
            of_interest |= cut ? left & ~(left - 1) : NodeMask{0};
        }
    }
    return of_interest & which;
}

/// The same, corner by corner, of rules with more than 64 nodes.
template <int dimension, class Real, bool indexed>
NodeMask IsosurfaceVisitor<dimension, Real, indexed>::cut_children(const Rule& rule,
                                                                   const Real* values,
                                                                   Real least_inside) const {
    NodeMask cut = 0;
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& child = rule.children[c];
        const std::size_t corners = topology(child.shape).corners;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < corners; ++i) {
            inside += values[child.corner[i] * components_] >= least_inside;
        }
        cut |= NodeMask{inside != 0 && inside != corners} << c;
    }
    return cut;
}

/// Leaves around which nothing is closed record nothing. Caps also lie in leaves that no level
/// passes through.
template <int dimension, class Real, bool indexed>
Leaves IsosurfaceVisitor<dimension, Real, indexed>::leaves(const Rule& rule, const Real* values,
                                                           NodeMask which, bool closed) {
    if (recording_ && !limited() && finest_ < 0 && !closed) return {};
    if (options_->cap) return {0, which};
    const NodeMask of_interest = leaves_of_interest(rule, values, which);
    const std::uint64_t before = counts_.calls;
    count(static_cast<std::uint64_t>(std::popcount(which)),
          static_cast<std::uint64_t>(std::popcount(of_interest)));
    if ((before >> 16U) != (counts_.calls >> 16U)) tick(0, 0);
    return {of_interest, 0};
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::count(std::uint64_t calls,
                                                        std::uint64_t visited) {
    counts_.calls += calls;
    counts_.visited += visited;
}

/// Reports the counts so far and these.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::tick(std::uint64_t calls,
                                                       std::uint64_t visited) const {
    if (!options_->progress) return;
    TraversalCounts counts = counts_;
    counts.calls += calls;
    counts.visited += visited;
    if (!options_->progress(counts)) throw Cancelled{};
}

/// Decides about an element without counting it.
template <int dimension, class Real, bool indexed>
Decision IsosurfaceVisitor<dimension, Real, indexed>::look(const View& s, const Split& split) {
    if (split.rule != nullptr && entries_ != nullptr) prefetch(*entries_, *split.rule, split.keys);
    Real lo = s.value[0];
    Real hi = lo;
    for (std::size_t i = 1; i < s.corner_count(); ++i) {
        const Real v = s.value[i * components_];
        lo = std::min(lo, v);
        hi = std::max(hi, v);
    }
    element_bound_ = split.rule == nullptr ? Real(0) : bound_of(*split.rule, split.keys);
    const bool capped = options_->cap && walk_->boundary(s) != 0;
    if (!of_interest(lo, hi, element_bound_, capped)) return {Visit::skip, 0};
    if (split.rule == nullptr) return {Visit::stop, 0};
    const NodeMask interpolated = holds({*split.rule, split.keys, s.level + 1, split.outside});
    return {interpolated == split.rule->all() ? Visit::stop : Visit::descend, interpolated};
}

/// Not below the bound.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE Real IsosurfaceVisitor<dimension, Real, indexed>::bound_of(
    const Rule& rule, std::span<const NodeKey> nodes) const {
    return as_real(own_bounds_ != nullptr ? own_bounds_->bound(rule, nodes)
                                          : bounds_->bound(rule, nodes));
}

template <int dimension, class Real, bool indexed>
NESTGRID_INLINE NodeMask
IsosurfaceVisitor<dimension, Real, indexed>::holds(const NewNodes& nodes) const {
    if (own_threshold_ == nullptr) return criterion_->holds(nodes);
    return own_bounds_->stops_at_most(nodes.rule, nodes.keys, own_threshold_->epsilon()) &
           ~nodes.outside;
}

}  // namespace nestgrid::engine
