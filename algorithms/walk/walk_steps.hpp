// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of a walk that are taken at every element. They are compiled anew for each class of
// visitors that calls Walk::run_as(), so that the compiler sees walk and visitor as one function.
#pragma once

#include <algorithm>
#include <bit>

#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <walk/corner_count.hpp>
#include <walk/crossing_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// A vector that only grows.
template <class T>
NESTGRID_INLINE T* with_room(std::vector<T>& vector, std::size_t count) {
    if (vector.size() < count) [[unlikely]]
        vector.resize(count);
    return vector.data();
}

template <class Real>
template <class V>
void Walk<Real>::run_as(V& visitor, std::size_t first, std::size_t last) const {
    std::unique_ptr<Stack> stack = take_stack();
    for (std::size_t i = first; i < last; ++i) {
        View view;
        if (make_coarse(i, *stack, view)) walk_below_as(view, visitor);
    }
    give_back(std::move(stack));
}

template <class Real>
template <class V>
void Walk<Real>::walk_below_as(const View& view, V& visitor) const {
    if (!visitor.takes(view)) visit(view, visitor);
}

template <class Real>
template <class V>
void Walk<Real>::visit(const View& view, V& visitor) const {
    const Member& member = *view.member;
    if (member.hidden == Hidden::wholly && !visitor.sees_hidden()) return;
    Split split;
    if (member.rule == nullptr) {
        if (visitor.inspect(view, split).visit != Visit::skip) visitor.extract(view);
        return;
    }
    const Rule& rule = *member.rule;
    split.rule = &rule;
    split.constrained = member.constrained;
    split.outside = member.outside;
    const std::size_t count = rule.new_nodes.size();
    if (carries_keys_) {
        const std::size_t corners = view.corner_count();
        NodeKey* const key = with_room(view.stack->frame(view.level).key, corners + count);
        this->corners(view, key, nullptr);
        for (std::size_t n = 0; n < count; ++n) {
            key[corners + n] = derived_key(rule.new_nodes[n], key);
        }
        split.keys = {key + corners, count};
    } else if (own_keys_) {
        split.keys = view.family->new_keys(member);
    }
    if (!constrained_ && hanging_ != nullptr) split.constrained = hanging_->mask(split.keys);
    if (hanging_ != nullptr) split.unseen = hanging_->unseen(split.keys);
    split.constrained |= split.unseen;
    if (fixed_ != nullptr) mark_crossing(view, split);
    Decision decision;
    if (count > 0) decision = visitor.inspect(view, split);
    if (decision.visit == Visit::skip) return;
    if (decision.visit == Visit::stop && member.hidden != Hidden::partly) {
        // Else the rank draws it that has its first leaf.
        if (member.presence != Presence::partly) visitor.extract(view);
    } else {
        descend(view, split, decision, visitor);
    }
}

template <class Real>
template <class V>
NESTGRID_INLINE void Walk<Real>::descend(const View& view, const Split& split,
                                         const Decision& decision, V& visitor) const {
    const Rule& rule = *split.rule;
    Frame<Real>& frame = view.stack->frame(view.level);
    NodeMask interpolated = decision.interpolated;
    const NodeMask mean = (interpolated | split.constrained) & rule.all();
    const NodeMask wanted = visitor.children(view);
    project(view, split, mean, wanted, frame);
    if (carries_positions_) project_positions(view, split, mean, frame);
    if (functions_ != nullptr) put_functions(view, split, mean, frame);
    if (!decision.weights.empty()) {
        interpolated |= blend(split, mean, decision.weights, frame);
    }
    if (!rule.new_nodes.empty()) visitor.entered(view, split, frame.value.data());
    const ClosingSplit<Real>* closing = nullptr;
    if (needs_.closed &&
        (view.closed.any || (mean | split.crossing) != 0 || rule.divides_bare_faces)) {
        closing = close(view, split, mean, frame);
    }
    visit_children(view, split, interpolated, closing, frame, visitor);
}

template <class Real>
NESTGRID_INLINE void Walk<Real>::corners(const View& view, NodeKey* keys, Point* positions) const {
    const std::size_t corners = view.corner_count();
    NodeKey* const own_keys = own_keys_ ? keys : nullptr;
    Point* const own_positions = own_positions_ ? positions : nullptr;
    if (own_keys != nullptr || own_positions != nullptr) {
        hierarchy_->corners(view.stack->task.get(), view.element(), corners, own_keys,
                            own_positions, nullptr);
    }
    const auto node = [&](std::size_t k) {
        return view.as == nullptr ? k : std::size_t{view.as->corner[k]};
    };
    for (std::size_t k = 0; keys != own_keys && k < corners; ++k) {
        keys[k] = view.nodes.key[node(k)];
    }
    for (std::size_t k = 0; positions != own_positions && k < corners; ++k) {
        positions[k] = view.nodes.position[node(k)];
    }
}

/// Enters the element, and puts P_S U at its corners and new nodes into the frame, eq. (2).
template <class Real>
NESTGRID_INLINE void Walk<Real>::project(const View& view, const Split& split, NodeMask mean,
                                         NodeMask wanted, Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const std::size_t stride = components_;
    Real* const value = with_room(frame.value, (corners + rule.new_nodes.size()) * stride);
    if (needs_.values && stride == 1) {
        with_corner_count(view.shape, [&](auto all) NESTGRID_INLINE_LAMBDA {
            for (std::size_t k = 0; k < all; ++k) value[k] = view.value[k];
        });
    } else if (needs_.values) {
        std::copy_n(view.value, corners * stride, value);
    }
    const NodeMask which = needs_.values ? rule.all() & ~(mean | split.crossing) : NodeMask{0};
    const NodeMask missing =
        hierarchy_->enter(view.stack->task.get(), view.element(), rule, which,
                          needs_.values ? value : nullptr, wanted, frame.family);
    if ((missing & which) != 0) [[unlikely]] {
        put_far_values(view, split, missing & which, value + corners * stride);
    }
    if (!needs_.values) return;
    if (split.crossing != 0) fixed_->put_values(split, value + corners * stride);
    for (NodeMask left = mean; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        for (std::size_t c = 0; c < stride; ++c) {
            value[(corners + n) * stride + c] =
                detail::interpolate(rule.new_nodes[n], value + c, stride);
        }
    }
}

/// Puts the positions of the corners and new nodes into the frame. True positions are projected
/// like the data.
template <class Real>
NESTGRID_INLINE void Walk<Real>::project_positions(const View& view, const Split& split,
                                                   NodeMask mean, Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const std::size_t count = rule.new_nodes.size();
    Point* const x = with_room(frame.position, corners + count);
    for (std::size_t k = 0; k < corners; ++k) {
        x[k] = view.nodes.position[view.as == nullptr ? k : view.as->corner[k]];
    }
    NodeMask given = 0;
    if (new_positions_) {
        given = rule.all() & ~mean;
        hierarchy_->new_positions(view.stack->task.get(), view.element(), given,
                                  {x + corners, count});
    }
    if (fixed_ != nullptr) given |= fixed_->put_positions(split.keys, x + corners);
    for (std::size_t n = 0; n < count; ++n) {
        if ((given >> n & 1U) == 0) x[corners + n] = detail::interpolate(rule.new_nodes[n], x);
    }
    if (!carries_placed_) return;
    Point* const placed = with_room(frame.placed, corners + count);
    placed_corners(view, placed);
    hierarchy_->new_positions(view.stack->task.get(), view.element(), rule.all(),
                              {placed + corners, count});
}

template <class Real>
template <class V>
NESTGRID_INLINE void Walk<Real>::visit_children(const View& view, const Split& split,
                                                NodeMask interpolated,
                                                const ClosingSplit<Real>* closing,
                                                Frame<Real>& frame, V& visitor) const {
    const Rule& rule = *split.rule;
    const Family& family = frame.family;
    NodeMask shown = family.leaves;
    if ((family.hidden & shown) != 0 && !visitor.sees_hidden()) shown &= ~family.hidden;
    Leaves leaves;
    if (shown != 0) leaves = visitor.leaves(rule, frame.value.data(), shown, closing != nullptr);
    with_room(frame.child_value, max_corners * components_);
    const bool any_interpolated = (view.interpolated | interpolated) != 0;
    View child = make_child(view, rule, frame);
    for (NodeMask left = family.split | leaves.extract | leaves.inspect; left != 0;
         left &= left - 1) {
        const auto c = static_cast<std::size_t>(std::countr_zero(left));
        set_child(view, rule.children[c], c, frame, child);
        if (any_interpolated) {
            child.interpolated = interpolated_corners(view, *child.as, interpolated);
        }
        if (closing != nullptr) {
            child.closed = split.crossing == 0
                               ? closing->around(*child.as)
                               : fixed_->around(split, *closing, *child.as, *frame.crossed);
        }
        if ((leaves.extract >> c & 1U) != 0) {
            visitor.extract(child);
        } else {
            visit(child, visitor);
        }
    }
}

/// Makes the view of a child, but for what set_child() sets.
template <class Real>
NESTGRID_INLINE auto Walk<Real>::make_child(const View& father, const Rule& rule,
                                            const Frame<Real>& frame) const -> View {
    View child;
    child.family = &frame.family;
    child.stack = father.stack;
    child.coarse = father.coarse;
    child.father = &father;
    child.made_by = &rule;
    child.value = frame.child_value.data();
    child.nodes.key = frame.key.data();
    child.nodes.position = frame.position.data();
    child.nodes.placed = frame.placed.data();
    child.closed.any = child.closed.any_face = false;
    child.level = father.level + 1;
    child.boundary = 0;
    child.interpolated = 0;
    return child;
}

/// Sets what differs between the children of one family, and puts the child's values into the
/// frame.
template <class Real>
NESTGRID_INLINE void Walk<Real>::set_child(const View& father, const Child& as, std::size_t c,
                                           Frame<Real>& frame, View& child) const {
    child.member = &frame.family.members[c];
    child.as = &as;
    child.path = father.path * NodeKey{0x9e3779b97f4a7c15ULL} + c + 1U;
    child.shape = as.shape;
    child.orientation = static_cast<std::int8_t>(father.orientation * as.orientation);
    child.child = static_cast<std::uint8_t>(c);
    if (father.boundary != 0) child.boundary = boundary_of_child(father, as);
    const Real* const from = frame.value.data();
    Real* const to = frame.child_value.data();
    if (components_ > 1) {
        copy_components(as, from, to);
    } else {
        with_corner_count(as.shape, [&](auto corners) NESTGRID_INLINE_LAMBDA {
            for (std::size_t i = 0; i < corners; ++i) to[i] = from[as.corner[i]];
        });
    }
}

/// Copies all components of the values at the corners of a child.
template <class Real>
void Walk<Real>::copy_components(const Child& as, const Real* from, Real* to) const {
    const std::size_t corners = nestgrid::topology(as.shape).corners;
    for (std::size_t i = 0; i < corners; ++i) {
        to = std::copy_n(from + as.corner[i] * components_, components_, to);
    }
}

/// Faces of a child on the boundary of the domain, one bit each.
template <class Real>
std::uint8_t Walk<Real>::boundary_of_child(const View& father, const Child& as) {
    const Topology& t = nestgrid::topology(as.shape);
    unsigned boundary = 0;
    for (std::size_t f = 0; f < t.faces; ++f) {
        const std::uint8_t g = as.parent_face[f];
        if (g != no_face && (father.boundary >> g & 1U) != 0) boundary |= 1U << f;
    }
    return static_cast<std::uint8_t>(boundary);
}

/// Corners of a child at which S holds, one bit each.
template <class Real>
std::uint8_t Walk<Real>::interpolated_corners(const View& father, const Child& as,
                                              NodeMask interpolated) {
    const std::size_t corners = father.corner_count();
    const std::size_t count = nestgrid::topology(as.shape).corners;
    unsigned result = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t n = as.corner[i];
        const NodeMask flag =
            n < corners ? NodeMask{father.interpolated} >> n : interpolated >> (n - corners);
        result |= static_cast<unsigned>(flag & 1U) << i;
    }
    return static_cast<std::uint8_t>(result);
}

}  // namespace nestgrid::engine
