// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/walk.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include <nestgrid/detail/coarse_boundary.hpp>
#include <nestgrid/detail/interpolate.hpp>
#include <nestgrid/error.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/far_values.hpp>
#include <walk/crossing_nodes.hpp>

namespace nestgrid::engine {

namespace {

/// A vector that only grows.
template <class T>
T* with_room(std::vector<T>& vector, std::size_t count) {
    if (vector.size() < count) vector.resize(count);
    return vector.data();
}

[[noreturn]] void throw_missing(NodeMask missing, std::size_t coarse) {
    throw GridError("the field has no value at corner " +
                    std::to_string(std::countr_zero(missing)) + " of coarse element " +
                    std::to_string(coarse));
}

template <class Real>
[[noreturn]] void throw_missing(NodeMask missing, const ElementView<Real>& view) {
    throw GridError("the field has no value at new node " +
                    std::to_string(std::countr_zero(missing)) + " of an element on level " +
                    std::to_string(view.level) + " below coarse element " +
                    std::to_string(view.coarse));
}

/// Moves the numbers at new nodes where S has a weight towards their interpolants (section 6), in
/// the order of the rule: an earlier node may be a parent of a later one.
/// \param functions the first components, or null; affine ones are interpolated already
/// \param value of the corners and, behind them, of the new nodes, `components` for each
template <class Number>
void blend(const Rule& rule, NodeMask mean, std::span<const float> weights,
           const PositionFunctions* functions, Number* value, std::size_t components) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    const std::size_t function_count = functions == nullptr ? 0 : functions->count();
    const auto rounded = [&](std::size_t c, Number number) {
        if (c >= function_count) return number;
        return static_cast<Number>(functions->rounded(c, static_cast<double>(number)));
    };
    for (std::size_t n = 0; n < weights.size(); ++n) {
        const bool is_mean = (mean >> n & 1U) != 0;
        if (!is_mean && !(weights[n] > 0)) continue;
        Number* const at = value + (corners + n) * components;
        for (std::size_t c = 0; c < components; ++c) {
            if (c < function_count && functions->affine(c)) continue;
            const Number between =
                rounded(c, detail::interpolate(rule.new_nodes[n], value + c, components));
            const auto [least, greatest] = std::minmax(between, at[c]);
            const Number blended =
                std::fma(static_cast<Number>(weights[n]), between - at[c], at[c]);
            at[c] = is_mean ? between : rounded(c, std::clamp(blended, least, greatest));
        }
    }
}

}  // namespace

template <class Real>
Walk<Real>::Walk(const Hierarchy<Real>& hierarchy, const Needs& needs, const HangingNodes* hanging,
                 const PositionFunctions* functions)
    : hierarchy_{&hierarchy},
      hanging_{hanging},
      needs_{needs},
      components_{static_cast<std::size_t>(hierarchy.facts().components)},
      functions_{functions},
      boundary_faces_{hierarchy.offers(Feature::boundary_faces)},
      own_keys_{hierarchy.offers(Feature::own_keys)},
      own_positions_{hierarchy.offers(Feature::own_positions)},
      new_positions_{hierarchy.offers(Feature::new_positions)},
      constrained_{hierarchy.offers(Feature::constrained)},
      carries_keys_{needs.keys && !own_keys_},
      carries_positions_{needs.positions && !own_positions_},
      carries_placed_{needs.placed && new_positions_} {
    if (hierarchy.offers(Feature::presence)) require_made_for_parts(hierarchy, needs.on_ranks);
    if (!boundary_faces_) boundary_ = detail::coarse_boundary(hierarchy);
    if (hanging != nullptr && hanging->crossing() != nullptr) {
        fixed_ = std::make_unique<FixedNodes<Real>>(hierarchy, *hanging->crossing(), needs.values,
                                                    functions);
    }
}

template <class Real>
std::unique_ptr<WalkStack<Real>> Walk<Real>::take_stack() const {
    std::unique_ptr<Stack> stack;
    {
        const std::scoped_lock lock(mutex_);
        if (!idle_.empty()) {
            stack = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!stack) stack = std::make_unique<Stack>();
    stack->task = hierarchy_->open();
    return stack;
}

template <class Real>
void Walk<Real>::give_back(std::unique_ptr<Stack> stack) const {
    stack->task.reset();
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(stack));
}

template <class Real>
void Walk<Real>::run(Visitor<Real>& visitor, std::size_t first, std::size_t last) const {
    std::unique_ptr<Stack> stack = take_stack();
    for (std::size_t i = first; i < last; ++i) {
        View view;
        if (make_coarse(i, *stack, view)) walk_below(view, visitor);
    }
    give_back(std::move(stack));
}

template <class Real>
void Walk<Real>::walk_below(const View& view, Visitor<Real>& visitor) const {
    if (!visitor.takes(view)) visit(view, visitor);
}

template <class Real>
bool Walk<Real>::make_coarse(std::size_t i, Stack& stack, View& view) const {
    hierarchy_->coarse(stack.task.get(), i, stack.coarse, stack.family);
    const Coarse& coarse = stack.coarse;
    const Shape only = hierarchy_->facts().only_shape;
    if (only != Shape::point && coarse.shape != only) {
        throw GridError("coarse element " + std::to_string(i) + " is a " +
                        std::string(topology(coarse.shape).name) +
                        ", but the grid says that all are " + std::string(topology(only).name) +
                        "s");
    }
    const Member& member = stack.family.members[0];
    if ((stack.family.split | stack.family.leaves) == 0) return false;  // masked
    const std::size_t corners = topology(coarse.shape).corners;
    if (carries_keys_) {
        for (std::size_t k = 0; k < corners; ++k) stack.key[k] = coarse_key(coarse.ids[k]);
    }
    view.member = &member;
    view.family = &stack.family;
    view.stack = &stack;
    view.coarse = i;
    view.father = nullptr;
    view.made_by = nullptr;
    view.as = nullptr;
    view.value = stack.value.data();
    view.node_key = stack.key.data();
    view.node_position = coarse.corners.data();
    view.node_placed = coarse.corners.data();
    view.path = detail::mix(static_cast<NodeKey>(i));
    view.closed.any = false;
    view.level = 0;
    view.shape = coarse.shape;
    view.orientation = coarse.orientation;
    view.child = 0;
    view.boundary = boundary_.empty() ? std::uint8_t{0} : boundary_[i];
    view.interpolated = 0;
    if (needs_.values) put_coarse_values(view);
    return true;
}

/// Puts the values at the corners of a coarse element into the stack.
template <class Real>
void Walk<Real>::put_coarse_values(View& view) const {
    const std::size_t corners = view.corner_count();
    Stack& stack = *view.stack;
    Real* const value = with_room(stack.value, corners * components_);
    NodeMask missing = hierarchy_->coarse_values(stack.task.get(), view.coarse, corners, value);
    if (missing != 0 && hierarchy_->facts().far_values != nullptr) {
        std::array<NodeKey, max_corners> keys;
        this->corners(view, keys.data(), nullptr);
        missing = hierarchy_->facts().far_values->give(std::span(keys).first(corners), missing,
                                                       value, components_);
    }
    const NodeMask unseen = unseen_corners(view);
    if ((missing & ~unseen) != 0) throw_missing(missing & ~unseen, view.coarse);
    for (std::size_t k = 0; k < corners; ++k) {
        if ((unseen >> k & 1U) != 0) std::fill_n(value + k * components_, components_, Real{0});
        if (functions_ != nullptr) {
            functions_->put(stack.coarse.corners[k], value + k * components_);
        }
    }
    view.value = value;
}

template <class Real>
void Walk<Real>::visit(const View& view, Visitor<Real>& visitor) const {
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

/// Sets Split::crossing. These nodes count as new ones that do not hang, and S holds at no fixed
/// one.
template <class Real>
void Walk<Real>::mark_crossing(const View& view, Split& split) const {
    const NodeMask fixed = fixed_->mask(split.keys);
    if (fixed == 0) return;
    split.outside |= fixed;
    SplitKeys keys;
    split.crossing = fixed_->crossing().made_otherwise(*split.rule, split_keys(view, split, keys));
    split.constrained &= ~split.crossing;
}

template <class Real>
void Walk<Real>::descend(const View& view, const Split& split, const Decision& decision,
                         Visitor<Real>& visitor) const {
    const Rule& rule = *split.rule;
    Frame<Real>& frame = view.stack->frame(view.level);
    NodeMask interpolated = decision.interpolated;
    const NodeMask mean = (interpolated | split.constrained) & rule.all();
    const NodeMask wanted = visitor.children(view);
    project(view, split, mean, wanted, frame);
    if (carries_positions_) project_positions(view, split, mean, frame);
    if (functions_ != nullptr) put_functions(view, split, mean, frame);
    if (!decision.weights.empty()) {
        blend(rule, mean, decision.weights, functions_, frame.value.data(), components_);
        if (carries_positions_ && new_positions_) {
            blend(rule, mean, decision.weights, nullptr, frame.position.data()->data(),
                  Point{}.size());
        }
        for (std::size_t n = 0; n < decision.weights.size(); ++n) {
            interpolated |= NodeMask{decision.weights[n] > 0} << n;
        }
    }
    if (!rule.new_nodes.empty()) visitor.entered(view, split, frame.value.data());
    const ClosingSplit<Real>* closing = nullptr;
    if (needs_.closed &&
        (view.closed.any || (mean | split.crossing) != 0 || rule.divides_bare_faces)) {
        closing = close(view, split, mean, frame);
    }
    visit_children(view, split, interpolated, closing, frame, visitor);
}

/// Enters the element, and puts P_S U at its corners and new nodes into the frame, eq. (2).
template <class Real>
void Walk<Real>::project(const View& view, const Split& split, NodeMask mean, NodeMask wanted,
                         Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const std::size_t stride = components_;
    Real* const value = with_room(frame.value, (corners + rule.new_nodes.size()) * stride);
    if (needs_.values) std::copy_n(view.value, corners * stride, value);
    const NodeMask which = needs_.values ? rule.all() & ~(mean | split.crossing) : NodeMask{0};
    NodeMask missing = hierarchy_->enter(view.stack->task.get(), view.element(), rule, which, value,
                                         wanted, frame.family);
    if ((missing & which) != 0 && hierarchy_->facts().far_values != nullptr) {
        missing = hierarchy_->facts().far_values->give(split.keys, missing & which,
                                                       value + corners * stride, stride);
    }
    if ((missing & which) != 0) throw_missing(missing & which, view);
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
void Walk<Real>::project_positions(const View& view, const Split& split, NodeMask mean,
                                   Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    const std::size_t corners = view.corner_count();
    const std::size_t count = rule.new_nodes.size();
    Point* const x = with_room(frame.position, corners + count);
    for (std::size_t k = 0; k < corners; ++k) {
        x[k] = view.node_position[view.as == nullptr ? k : view.as->corner[k]];
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

/// Finds the edges and faces of the rule that the split closes.
template <class Real>
const ClosingSplit<Real>* Walk<Real>::close(const View& view, const Split& split, NodeMask mean,
                                            Frame<Real>& frame) const {
    const std::size_t corners = view.corner_count();
    if (!frame.closing) frame.closing = std::make_unique<ClosingSplit<Real>>();
    if (!carries_keys_) {
        NodeKey* const key = with_room(frame.key, corners + split.keys.size());
        hierarchy_->corners(view.stack->task.get(), view.element(), corners, key, nullptr, nullptr);
        std::ranges::copy(split.keys, key + corners);
    }
    auto& closing = *frame.closing;
    closing.split.key = frame.key.data();
    closing.split.new_key = frame.key.data() + corners;
    closing.split.element = &view;
    closing.split.rule = split.rule;
    closing.split.value = frame.value.data();
    closing.split.components = components_;
    closing.split.places = carries_positions_ ? frame.position.data() : nullptr;
    closing.close(view, *split.rule, mean);
    if (split.crossing != 0) {
        if (!frame.crossed) frame.crossed = std::make_unique<CrossedSplit<Real>>();
        fixed_->close_parts(split, mean, closing, *frame.crossed);
    }
    return &closing;
}

template <class Real>
void ClosingSplit<Real>::close(const ElementView<Real>& view, const Rule& rule, NodeMask mean) {
    const Topology& t = view.topology();
    edges_closed = 0;
    faces_closed = 0;
    edge[max_rule_edges] = nullptr;
    face[max_rule_faces] = nullptr;
    // Which edges and faces are closed nobody can predict: they are chosen without branches.
    for (std::size_t e = 0; e < rule.edges.size(); ++e) {
        const RuleEdge& of = rule.edges[e];
        closed_edge[e] = {&split, {of.end[0], of.end[1]}};
        const MaximalEdge<Real>* outer = e < t.edges ? view.closed.edge(e) : nullptr;
        const MaximalEdge<Real>* own = of.inner != 0 ? &closed_edge[e] : nullptr;
        const bool divided = (of.inner & ~mean) != 0;
        const std::array around{outer != nullptr ? outer : own,
                                static_cast<const MaximalEdge<Real>*>(nullptr)};
        edge[e] = around[divided];
        edges_closed |= std::uint32_t{edge[e] != nullptr} << e;
    }
    for (std::size_t f = 0; f < rule.faces.size(); ++f) {
        const RuleFace& of = rule.faces[f];
        const ClosedFace* outer = of.parent != no_face ? face[of.parent] : view.closed.face(f);
        closed_face[f] = {outer, &of, &split};
        const bool closes = of.divided && (of.inner & ~mean) == 0;
        const std::array around{outer, static_cast<const ClosedFace*>(closed_face.data() + f)};
        face[f] = around[closes];
        faces_closed |= std::uint32_t{face[f] != nullptr} << f;
    }
}

template <class Real>
void Walk<Real>::visit_children(const View& view, const Split& split, NodeMask interpolated,
                                const ClosingSplit<Real>* closing, Frame<Real>& frame,
                                Visitor<Real>& visitor) const {
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
auto Walk<Real>::make_child(const View& father, const Rule& rule, const Frame<Real>& frame) const
    -> View {
    View child;
    child.family = &frame.family;
    child.stack = father.stack;
    child.coarse = father.coarse;
    child.father = &father;
    child.made_by = &rule;
    child.value = frame.child_value.data();
    child.node_key = frame.key.data();
    child.node_position = frame.position.data();
    child.node_placed = frame.placed.data();
    child.closed.any = false;
    child.level = father.level + 1;
    child.boundary = 0;
    child.interpolated = 0;
    return child;
}

/// Sets what differs between the children of one family, and puts the child's values into the
/// frame.
template <class Real>
void Walk<Real>::set_child(const View& father, const Child& as, std::size_t c, Frame<Real>& frame,
                           View& child) const {
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
    } else if (as.shape == Shape::hexahedron) {
        for (std::size_t i = 0; i < 8; ++i) to[i] = from[as.corner[i]];
    } else {
        const std::size_t corners = nestgrid::topology(as.shape).corners;
        for (std::size_t i = 0; i < corners; ++i) to[i] = from[as.corner[i]];
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

template class WalkStack<float>;
template class WalkStack<double>;
template struct ClosingSplit<float>;
template struct ClosingSplit<double>;
// One by one: what other files define would be a weak symbol here, which pulls no object out of an
// archive when the linker optimises.
template Walk<float>::Walk(const Hierarchy<float>&, const Needs&, const HangingNodes*,
                           const PositionFunctions*);
template Walk<double>::Walk(const Hierarchy<double>&, const Needs&, const HangingNodes*,
                            const PositionFunctions*);
template void Walk<float>::run(Visitor<float>&, std::size_t, std::size_t) const;
template void Walk<double>::run(Visitor<double>&, std::size_t, std::size_t) const;
template void Walk<float>::walk_below(const View&, Visitor<float>&) const;
template void Walk<double>::walk_below(const View&, Visitor<double>&) const;

}  // namespace nestgrid::engine
