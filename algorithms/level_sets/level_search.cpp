// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/level_search_steps.hpp>

#include <algorithm>

namespace nestgrid::engine {

template <class Real>
LevelSearch<Real>::LevelSearch(const Walk<Real>& walk, std::span<const Level<Real>> levels,
                               const Criterion& criterion, const Bounds& bounds)
    : levels_{levels},
      walk_{&walk},
      components_{walk.components()},
      functions_{walk.function_count()},
      criterion_{&criterion},
      bounds_{&bounds},
      range_{bounds},
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
        packed_threshold_ = Pack<float>::all(detail::float_below(threshold->epsilon()));
        looks_plainly_ = levels_.size() == 1 && components_ == 1 && functions_ == 0 &&
                         asks_for_masks_ && threshold->epsilon() >= 0;
        if (looks_plainly_) most_ = detail::bfloat16_below(threshold->epsilon());
    }
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
    const auto beyond_hull = static_cast<double>(view.inner_bounds().beyond_hull);
    const auto [least, greatest] = functions.range(
        component, std::span<const Point>(x).first(view.corner_count()),
        {static_cast<double>(range.lo), static_cast<double>(range.hi)},
        static_cast<double>(view.value[component]),
        beyond_hull >= 0 ? beyond_hull
                         : functions.distance_beyond_hull(split.keys, view.interpolated == 0));
    return of_interest(static_cast<Real>(least), static_cast<Real>(greatest), 0, component, caps);
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

template class LevelSearch<float>;
template class LevelSearch<double>;

}  // namespace nestgrid::engine
