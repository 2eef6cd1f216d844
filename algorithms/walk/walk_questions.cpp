// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What visitors ask a walk about the element at hand.
#include <algorithm>

#include <nestgrid/detail/interpolate.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

template <class Real>
std::span<const NodeKey> Walk<Real>::split_keys(const View& view, const Split& split,
                                                SplitKeys& out) const {
    const std::size_t corners = view.corner_count();
    this->corners(view, out.data(), nullptr);
    std::ranges::copy(split.keys, out.data() + corners);
    return std::span<const NodeKey>(out).first(corners + split.keys.size());
}

template <class Real>
std::array<Point, 2> Walk<Real>::positions(const MaximalEdge<Real>& edge) const {
    const auto& split = *edge.split;
    const auto& [a, b] = edge.end;
    if (split.places != nullptr) return {split.places[a], split.places[b]};
    const std::size_t corners = split.element->corner_count();
    std::array<Point, max_corners + max_new_nodes> x;
    this->corners(*split.element, nullptr, x.data());
    for (std::size_t n = corners; n <= std::max(a, b); ++n) {
        const bool asked = n == a || n == b;
        if (!asked && split.rule->steps == 1) continue;  // not a parent of another new node
        x[n] = detail::interpolate(split.rule->new_nodes[n - corners], x.data());
    }
    return {x[a], x[b]};
}

template <class Real>
std::span<const Point> Walk<Real>::split_positions(const View& view, const Split& split,
                                                   SplitPositions& out) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const std::size_t count = rule.new_nodes.size();
    this->corners(view, nullptr, out.data());
    NodeMask interpolated = rule.all();
    if (new_positions_) {
        interpolated &= split.constrained;
        hierarchy_->new_positions(view.stack->task.get(), view.element(), rule.all(),
                                  std::span(out).subspan(corners, count));
    }
    for (std::size_t n = 0; n < count; ++n) {
        if ((interpolated >> n & 1U) == 0) continue;
        out[corners + n] = detail::interpolate(rule.new_nodes[n], out.data());
    }
    return std::span<const Point>(out).first(corners + count);
}

template <class Real>
NodeMask Walk<Real>::unseen_corners(const View& view) const {
    if (hanging_ == nullptr || !hanging_->any_unseen()) return 0;
    std::array<NodeKey, max_corners> keys;
    corners(view, keys.data(), nullptr);
    return hanging_->unseen(std::span(keys).first(view.corner_count()));
}

template <class Real>
unsigned Walk<Real>::boundary(const View& view) const {
    if (!boundary_faces_) return view.boundary;
    unsigned faces = 0;
    hierarchy_->corners(view.stack->task.get(), view.element(), 0, nullptr, nullptr, &faces);
    return faces;
}

template <class Real>
void Walk<Real>::gradients(const View& view, std::span<Point> out) const {
    hierarchy_->corner_gradients(view.stack->task.get(), view.element(), out);
}

template <class Real>
void Walk<Real>::placed_corners(const View& view, Point* out) const {
    for (std::size_t k = 0; k < view.corner_count(); ++k) {
        out[k] = view.nodes.placed[view.as == nullptr ? k : std::size_t{view.as->corner[k]}];
    }
}

template std::span<const NodeKey> Walk<float>::split_keys(const View&, const Split&,
                                                          SplitKeys&) const;
template std::span<const NodeKey> Walk<double>::split_keys(const View&, const Split&,
                                                           SplitKeys&) const;
template std::array<Point, 2> Walk<float>::positions(const MaximalEdge<float>&) const;
template std::array<Point, 2> Walk<double>::positions(const MaximalEdge<double>&) const;
template std::span<const Point> Walk<float>::split_positions(const View&, const Split&,
                                                             SplitPositions&) const;
template std::span<const Point> Walk<double>::split_positions(const View&, const Split&,
                                                              SplitPositions&) const;
template NodeMask Walk<float>::unseen_corners(const View&) const;
template NodeMask Walk<double>::unseen_corners(const View&) const;
template unsigned Walk<float>::boundary(const View&) const;
template unsigned Walk<double>::boundary(const View&) const;
template void Walk<float>::gradients(const View&, std::span<Point>) const;
template void Walk<double>::gradients(const View&, std::span<Point>) const;
template void Walk<float>::corners(const View&, NodeKey*, Point*) const;
template void Walk<double>::corners(const View&, NodeKey*, Point*) const;
template void Walk<float>::placed_corners(const View&, Point*) const;
template void Walk<double>::placed_corners(const View&, Point*) const;

}  // namespace nestgrid::engine
