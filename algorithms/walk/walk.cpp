// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/walk_steps.hpp>

#include <cmath>
#include <string>

#include <nestgrid/detail/coarse_boundary.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/far_values.hpp>

namespace nestgrid::engine {

namespace {

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
    run_as(visitor, first, last);
}

template <class Real>
void Walk<Real>::walk_below(const View& view, Visitor<Real>& visitor) const {
    walk_below_as(view, visitor);
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
    view.nodes.key = stack.key.data();
    view.nodes.position = coarse.corners.data();
    view.nodes.placed = coarse.corners.data();
    view.path = detail::mix(static_cast<NodeKey>(i));
    view.closed.any = view.closed.any_face = false;
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

/// Sets Split::crossing. These nodes count as new ones that do not hang, and S holds at no fixed
/// one.
template <class Real>
void Walk<Real>::mark_crossing(const View& view, Split& split) const {
    const NodeMask fixed = fixed_->mask(split.keys);
    if (fixed == 0) return;
    split.outside |= fixed;
    SplitKeys keys;
    split.crossing =
        fixed_->crossing().made_by_other_stencils(*split.rule, split_keys(view, split, keys));
    split.constrained &= ~split.crossing;
}

/// Puts values from other ranks where the field has none.
/// \param missing the new nodes whose values are needed
/// \param out the values at the new nodes
///
/// \throw GridError where there is none
template <class Real>
void Walk<Real>::put_far_values(const View& view, const Split& split, NodeMask missing,
                                Real* out) const {
    const FarValues* const far = hierarchy_->facts().far_values;
    if (far != nullptr) missing = far->give(split.keys, missing, out, components_);
    if (missing != 0) throw_missing(missing, view);
}

/// Moves values and true positions at new nodes where S has a weight towards their interpolants.
/// \return the nodes at which the weight is greater than 0
template <class Real>
NodeMask Walk<Real>::blend(const Split& split, NodeMask mean, std::span<const float> weights,
                           Frame<Real>& frame) const {
    const Rule& rule = *split.rule;
    engine::blend(rule, mean, weights, functions_, frame.value.data(), components_);
    if (carries_positions_ && new_positions_) {
        engine::blend(rule, mean, weights, nullptr, frame.position.data()->data(), Point{}.size());
    }
    NodeMask weighted = 0;
    for (std::size_t n = 0; n < weights.size(); ++n) weighted |= NodeMask{weights[n] > 0} << n;
    return weighted;
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
template NodeMask Walk<float>::blend(const Split&, NodeMask, std::span<const float>,
                                     Frame<float>&) const;
template NodeMask Walk<double>::blend(const Split&, NodeMask, std::span<const float>,
                                      Frame<double>&) const;
template void Walk<float>::put_far_values(const View&, const Split&, NodeMask, float*) const;
template void Walk<double>::put_far_values(const View&, const Split&, NodeMask, double*) const;
template void Walk<float>::mark_crossing(const View&, Split&) const;
template void Walk<double>::mark_crossing(const View&, Split&) const;
template const ClosingSplit<float>* Walk<float>::close(const View&, const Split&, NodeMask,
                                                       Frame<float>&) const;
template const ClosingSplit<double>* Walk<double>::close(const View&, const Split&, NodeMask,
                                                         Frame<double>&) const;
template std::unique_ptr<WalkStack<float>> Walk<float>::take_stack() const;
template std::unique_ptr<WalkStack<double>> Walk<double>::take_stack() const;
template void Walk<float>::give_back(std::unique_ptr<WalkStack<float>>) const;
template void Walk<double>::give_back(std::unique_ptr<WalkStack<double>>) const;
template bool Walk<float>::make_coarse(std::size_t, WalkStack<float>&, View&) const;
template bool Walk<double>::make_coarse(std::size_t, WalkStack<double>&, View&) const;
template void Walk<float>::run(Visitor<float>&, std::size_t, std::size_t) const;
template void Walk<double>::run(Visitor<double>&, std::size_t, std::size_t) const;
template void Walk<float>::walk_below(const View&, Visitor<float>&) const;
template void Walk<double>::walk_below(const View&, Visitor<double>&) const;

}  // namespace nestgrid::engine
