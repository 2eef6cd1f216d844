// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/descent.hpp>

#include <algorithm>
#include <limits>

#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Corners = std::array<Point, max_corners>;

template <class Real>
std::span<const Point> corners_of(const Walk<Real>& walk, const ElementView<Real>& view,
                                  Corners& out) {
    walk.corners(view, nullptr, out.data());
    return std::span(out).first(view.corner_count());
}

}  // namespace

template <class Real>
Descent<Real>::Descent(const Walk<Real>& walk, const Criterion& criterion,
                       std::span<const Point> points, double margin, ProbeResult& result)
    : walk_{&walk},
      criterion_{&criterion},
      points_{points},
      margin_{margin},
      curved_{walk.hierarchy().offers(Feature::new_positions)},
      result_{&result},
      distance_(points.size(), -infinity) {}

template <class Real>
void Descent<Real>::run(Group found) {
    coarse_ = found;
    for (std::size_t i = 0; i < found.size();) {
        const std::size_t first = found[i].element;
        std::size_t last = first;
        while (i < found.size() && found[i].element <= last) {
            last = std::size_t{found[i++].element} + 1;
        }
        walk_->run(*this, first, last);
    }
}

template <class Real>
Decision Descent<Real>::inspect(const View& view, const Split& split) {
    ++result_->counts.calls;
    arrive(view);
    if (at_level(view.level).group.empty()) return {Visit::skip};
    ++result_->counts.visited;
    if (split.rule == nullptr) return {Visit::stop};
    return question_.ask(*walk_, *criterion_, view, split);
}

template <class Real>
void Descent<Real>::extract(const View& view) {
    ++result_->counts.extracted;
    const std::size_t corners = view.corner_count();
    const std::size_t components = result_->components;
    Corners x;
    double least = -infinity;
    if (margin_ != 0) least = -face_tolerance(corners_of(*walk_, view, x));
    for (const PointInElement& in : at_level(view.level).group) {
        const double distance = face_distance(view.shape, in.at);
        if (!(distance >= least) || !(distance > distance_[in.point])) continue;
        if (margin_ != 0) {
            const Point place = place_of(view.shape, x, in.at);
            const double size = extent(std::span(x).first(corners));
            if (!(norm(points_[in.point] - place) <= off_surface * size)) continue;
        }
        distance_[in.point] = distance;
        result_->level[in.point] = view.level;
        const auto weight = shape_functions(view.shape, in.at);
        for (std::size_t c = 0; c < components; ++c) {
            double sum = 0;
            for (std::size_t k = 0; k < corners; ++k) {
                sum += weight[k] * static_cast<double>(view.value[k * components + c]);
            }
            result_->values[in.point * components + c] = sum;
        }
    }
}

/// Hands the points of an element to its children. \return the children that have any
template <class Real>
NodeMask Descent<Real>::children(const View& view) {
    const Rule& rule = *view.member->rule;
    if (rule.new_nodes.empty()) arrive(view);  // inspect() was not called
    Level& level = at_level(view.level);
    if (level.maps == nullptr || level.maps->rule != &rule) level.maps = &maps_.of(rule);
    level.nested = !curved_ && (level.affine || level.maps->nested);
    handed_.clear();
    if (margin_ != 0) {
        hand_to_all(*level.maps, level.group, 2 * margin(view.level), handed_);
    } else if (level.nested) {
        hand_to_deepest(*level.maps, level.group, handed_);
    }
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
        if (margin_ != 0) refine(view, level.group);
    }
}

/// Makes reference coordinates those of the element's own map, and drops points that are far away.
template <class Real>
void Descent<Real>::refine(const View& view, Group& group) {
    const bool nested = at_level(view.level - 1).nested;
    Corners x;
    const auto corners = nested ? std::span<const Point>{} : corners_of(*walk_, view, x);
    const auto is_far = [&](PointInElement& in) {
        const bool converged = nested || invert(view.shape, corners, points_[in.point], in.at);
        return !converged || !(face_distance(view.shape, in.at) >= -margin(view.level));
    };
    group = {group.begin(), std::remove_if(group.begin(), group.end(), is_far)};
}

template class Descent<float>;
template class Descent<double>;

}  // namespace nestgrid::engine
