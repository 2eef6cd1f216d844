// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/level_search.hpp>

#include <algorithm>
#include <bit>

#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

namespace {

/// The least number of type Real that is not below a bound.
template <class Real>
Real as_real(double bound) {
    if constexpr (sizeof(Real) == sizeof(double)) return bound;
    return float_above(bound);
}

}  // namespace

template <class Real>
LevelSearch<Real>::LevelSearch(const Walk<Real>& walk, std::span<const Level<Real>> levels,
                               const Criterion& criterion, const Bounds& bounds)
    : levels_{levels},
      walk_{&walk},
      components_{walk.components()},
      functions_{walk.function_count()},
      criterion_{&criterion},
      bounds_{&bounds},
      own_bounds_{dynamic_cast<const HierarchicalIndicator*>(&bounds)},
      entries_{own_bounds_ == nullptr ? nullptr : &own_bounds_->entries()},
      saturated_{criterion.saturated()},
      asks_for_masks_{!criterion.wants_positions() && !criterion.blends()},
      never_stops_{criterion.never_holds()} {
    for (const Level<Real>& level : levels_) {
        last_component_ = std::max(last_component_, level.component);
    }
    const Threshold* const threshold = criterion.as_threshold();
    if (threshold != nullptr && own_bounds_ != nullptr && threshold->indicator() == own_bounds_) {
        own_threshold_ = threshold;
        packed_threshold_ = Pack<float>::all(float_below(threshold->epsilon()));
    }
}

template <class Real>
bool may_stop_apart(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                    const Bounds& bounds) {
    if (hierarchy.offers(Feature::constrained) || bounds.hanging() != nullptr) return true;
    if (const SharedNodes* shared = hierarchy.facts().shared; shared != nullptr) {
        if (shared->any_hangs()) return true;
    }
    if (criterion.never_holds()) return false;
    return hierarchy.offers(Feature::hidden) || !bounds.stops_conform();
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

template <class Real>
std::size_t LevelSearch<Real>::corners_at_zero(const View& view, std::size_t component) const {
    std::size_t count = 0;
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        count += view.value[k * components_ + component] == 0 ? 1 : 0;
    }
    return count;
}

/// Whether a slice may pass through an element, or one of its faces on the boundary may lie in the
/// slice: where no element is below the slice, the element above draws it.
template <class Real>
bool LevelSearch<Real>::looks_at_function(const View& view, const Split& split,
                                          std::size_t component, bool caps) const {
    Range range = range_of(view, component);
    if (range.lo == 0 && corners_at_zero(view, component) >= 3 && walk_->boundary(view) != 0) {
        range.lo = -range.hi;
    }
    if (of_interest(range.lo, range.hi, 0, component, caps)) return true;
    const PositionFunctions& functions = *walk_->functions();
    if (view.is_leaf() || functions.affine(component)) return false;
    std::array<Point, max_corners> x;
    walk_->corners(view, nullptr, x.data());
    const auto [least, greatest] =
        functions.range(component, std::span<const Point>(x).first(view.corner_count()),
                        {static_cast<double>(range.lo), static_cast<double>(range.hi)},
                        static_cast<double>(view.value[component]),
                        functions.stray(split.keys, view.interpolated == 0));
    return of_interest(static_cast<Real>(least), static_cast<Real>(greatest), 0, component, caps);
}

template <class Real>
auto LevelSearch<Real>::look(const View& view, const Split& split, bool caps,
                             CriterionQuestion& question) const -> Sight {
    const Rule* const rule = split.rule;
    if (rule != nullptr && entries_ != nullptr) prefetch(*entries_, *rule, split.keys);
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
    if (stops_unasked(saturated_, view, split)) {
        return {{Visit::stop, rule->all()}, bound};
    }
    if (!asks_for_masks_) return {question.ask(*walk_, *criterion_, view, split), bound};
    const NodeMask interpolated = holds({*rule, split.keys, view.level + 1, split.outside});
    return {{interpolated == rule->all() ? Visit::stop : Visit::descend, interpolated}, bound};
}

template <class Real>
Leaves LevelSearch<Real>::cut_leaves(const Rule& rule, const Real* values, NodeMask which) const {
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
            const bool cut = (all & inside) != 0 && (all & ~inside) != 0;
            of_interest |= cut ? left & ~(left - 1) : NodeMask{0};
            lie_in |= std::popcount(all & at_level) >= 3 ? left & ~(left - 1) : NodeMask{0};
        }
    }
    return {of_interest & which, lie_in & which & ~of_interest};
}

/// The children with corners on both sides of a level, found corner by corner: for rules with more
/// than 64 nodes.
template <class Real>
NodeMask LevelSearch<Real>::cut_children(const Rule& rule, const Real* values,
                                         const Level<Real>& level) const {
    NodeMask cut = 0;
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& child = rule.children[c];
        const std::size_t corners = topology(child.shape).corners;
        std::size_t inside = 0;
        for (std::size_t i = 0; i < corners; ++i) {
            const std::size_t at = child.corner[i] * components_ + level.component;
            inside += values[at] >= level.least_inside;
        }
        cut |= NodeMask{inside != 0 && inside != corners} << c;
    }
    return cut;
}

template <class Real>
auto LevelSearch<Real>::glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                               bool outside) const -> Glance {
    const std::span<const NodeKey> keys(&node, 1);
    const Real bound = bound_of(rule, keys);
    if (!of_interest(lo, hi, functions_ > 0 ? Real(0) : bound, 0, false)) {
        return {Visit::skip, bound};
    }
    const NodeMask mask = holds({rule, keys, level + 1, outside ? NodeMask{1} : NodeMask{0}});
    return {mask != 0 ? Visit::stop : Visit::descend, bound};
}

/// How far a component may leave the range of the corner values on an element with these new nodes.
template <class Real>
Real LevelSearch<Real>::bound_of(const Rule& rule, std::span<const NodeKey> nodes) const {
    return as_real<Real>(own_bounds_ != nullptr ? own_bounds_->bound(rule, nodes)
                                                : bounds_->bound(rule, nodes));
}

template <class Real>
NodeMask LevelSearch<Real>::holds(const NewNodes& nodes) const {
    if (own_threshold_ == nullptr) return criterion_->holds(nodes);
    return own_bounds_->stops_at_most(nodes.rule, nodes.keys, own_threshold_->epsilon()) &
           ~nodes.outside;
}

template bool may_stop_apart(const Hierarchy<float>&, const Criterion&, const Bounds&);
template bool may_stop_apart(const Hierarchy<double>&, const Criterion&, const Bounds&);
template class LevelSearch<float>;
template class LevelSearch<double>;

}  // namespace nestgrid::engine
