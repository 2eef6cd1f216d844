// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/descent.hpp>

#include <algorithm>

#include <nestgrid/detail/shape_functions.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

namespace {

using Corners = std::array<Point, max_corners>;

template <class Real>
std::span<const Point> corners_of(const Walk<Real>& walk, const ElementView<Real>& view,
                                  Corners& out) {
    walk.corners(view, nullptr, out.data());
    return std::span(out).first(view.corner_count());
}

}  // namespace

template <class Real>
void Descent<Real>::run(Group found) {
    coarse_ = found;
    for_each_run(found,
                 [&](std::size_t first, std::size_t last) { walk_->run(*this, first, last); });
}

template <class Real>
Decision Descent<Real>::inspect(const View& view, const Split& split) {
    found_->counts().calls += counted(view);
    arrive(view);
    if (at_level(view.level).group.empty()) return {Visit::skip};
    found_->counts().visited += counted(view);
    if (split.rule == nullptr) return {Visit::stop};
    return question_.ask(*walk_, *criterion_, view, split);
}

template <class Real>
void Descent<Real>::extract(const View& view) {
    ++found_->counts().extracted;
    found_->begin_element();
    for (const PointInElement& in : at_level(view.level).group) {
        found_->offer(view, in.point, in.at, shape_functions(view.shape, in.at),
                      face_distance(view.shape, in.at));
    }
}

/// Hands the points of an element to its children. \return the children that have any
template <class Real>
NodeMask Descent<Real>::children(const View& view) {
    const Rule& rule = *view.member->rule;
    if (rule.new_nodes.empty()) arrive(view);  // inspect() was not called
    Level& level = at_level(view.level);
    if (level.maps == nullptr || level.maps->rule != &rule) level.maps = &maps_.of(rule);
    level.nested = level.affine || level.maps->nested;
    handed_.clear();
    if (level.nested) hand_to_deepest(*level.maps, level.group, handed_);
    return level.handed.sort(handed_, rule.children.size());
}

template <class Real>
auto Descent<Real>::at_level(int level) -> Level& {
    const auto at = static_cast<std::size_t>(level);
    while (levels_.size() <= at) levels_.emplace_back();
    return levels_[at];
}

/// Sets the group of an element from what its father handed to it.
template <class Real>
void Descent<Real>::arrive(const View& view) {
    Level& level = at_level(view.level);
    if (view.father == nullptr) {
        const auto coarse = static_cast<std::uint32_t>(view.coarse);
        level.group =
            Group(std::ranges::lower_bound(coarse_, coarse, {}, &PointInElement::element),
                  std::ranges::upper_bound(coarse_, coarse, {}, &PointInElement::element));
        Corners x;
        level.affine = is_affine(view.shape, corners_of(*walk_, view, x));
    } else {
        Level& father = at_level(view.level - 1);
        level.group = father.handed.of(view.child);
        const bool affine = father.affine && father.maps->child[view.child].affine();
        level.affine = is_simplex(view.shape) || (father.nested && affine);
    }
}

template class Descent<float>;
template class Descent<double>;

}  // namespace nestgrid::engine
