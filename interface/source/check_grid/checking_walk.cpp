// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "checking_walk.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace nestgrid::detail {

void CheckingWalk::run() {
    const std::size_t count = inspection_->hierarchy().coarse_count();
    for (std::size_t i = 0; i < count; ++i) {
        inspection_->hierarchy().coarse(inspection_->task(), i, coarse_, coarse_family_);
        show([&](GridLaw& law) { law.visit(coarse_, i); });
    }
    show([](GridLaw& law) { law.finish_coarse(); });
    for (std::size_t i = 0; i < count; ++i) walk_coarse(i);
    inspection_->finish_hidden();
    show([](GridLaw& law) { law.finish(); });
    for (std::size_t i = 0; i < count; ++i) {
        CheckedElement element = coarse_element(i);
        if (is_masked(coarse_family_, 0)) continue;
        const Topology& t = topology(element.shape);
        for (std::size_t k = 0; k < t.corners; ++k) element.corner[k].position = t.reference[k];
        walk_again(element);
    }
}

auto CheckingWalk::frame(int level) -> Frame& {
    while (frames_.size() <= static_cast<std::size_t>(level)) frames_.emplace_back();
    return frames_[static_cast<std::size_t>(level)];
}

/// A hash of the ids of the coarse element that the walk is in, with weights.
NodeKey CheckingWalk::place_of(const std::array<double, max_corners>& weights) const {
    NodeKey sum = 0;
    for (std::size_t k = 0; k < topology(coarse_.shape).corners; ++k) {
        const auto quantised = static_cast<std::uint64_t>(std::llround(weights[k] * 0x1p40));
        if (quantised != 0) sum += mix(coarse_key(coarse_.ids[k]) + quantised);
    }
    return mix(sum);
}

/// Enters coarse element i.
/// \return the element, but for the keys and values of its corners
CheckedElement CheckingWalk::coarse_element(std::size_t i) {
    inspection_->hierarchy().coarse(inspection_->task(), i, coarse_, coarse_family_);
    CheckedElement element{.member = &coarse_family_.members[0],
                           .family = &coarse_family_,
                           .shape = coarse_.shape,
                           .step = inspection_->add_first_step(i),
                           .coarse = i,
                           .coarse_size = 0,
                           .level = 0,
                           .corner = {}};
    for (std::size_t k = 0; k < topology(element.shape).corners; ++k) {
        CheckedNode& c = element.corner[k];
        c.weights[k] = 1;
        c.place = place_of(c.weights);
        c.position = coarse_.corners[k];
        element.coarse_size =
            std::max(element.coarse_size, norm(coarse_.corners[k] - coarse_.corners[0]));
    }
    return element;
}

/// \param nodes corners and new nodes of the father, whose split is in its frame
CheckedElement CheckingWalk::child(const CheckedElement& father, std::size_t number,
                                   const std::vector<CheckedNode>& nodes) {
    const Family& family = frame(father.level).children;
    const Child& as = father.member->rule->children[number];
    CheckedElement child{.member = &family.members[number],
                         .family = &family,
                         .shape = as.shape,
                         .step = inspection_->add_step(father.step, number),
                         .coarse = father.coarse,
                         .coarse_size = father.coarse_size,
                         .level = father.level + 1,
                         .corner = {}};
    for (std::size_t i = 0; i < topology(as.shape).corners; ++i) {
        child.corner[i] = nodes[as.corner[i]];
    }
    return child;
}

/// \param nodes that the stencil may name
/// \return the new node, with a derived key
CheckedNode CheckingWalk::make_node(const Stencil& stencil,
                                    const std::vector<CheckedNode>& nodes) const {
    CheckedNode made;
    std::array<NodeKey, max_corners + max_new_nodes> keys;
    for (std::size_t k = 0; k < nodes.size(); ++k) keys[k] = nodes[k].key;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        const CheckedNode& parent = nodes[stencil.parent[i]];
        for (std::size_t k = 0; k < max_corners; ++k) {
            made.weights[k] += stencil.weight[i] * parent.weights[k];
        }
        made.position = made.position + stencil.weight[i] * parent.position;
    }
    made.place = place_of(made.weights);
    made.key = derived_key(stencil, keys.data());
    return made;
}

/// The values at nodes of which no leaf is here come from other processes (DistributedField): where
/// parts may be elsewhere, no value counts.
/// \return the nodes without a value
NodeMask CheckingWalk::values_that_count(std::span<double> values, NodeMask missing) const {
    if (!inspection_->offers(Feature::presence)) return missing;
    std::ranges::fill(values, 0.0);
    return 0;
}

void CheckingWalk::walk_coarse(std::size_t i) {
    CheckedElement element = coarse_element(i);
    if (is_masked(coarse_family_, 0)) return;
    const Hierarchy<double>& hierarchy = inspection_->hierarchy();
    Task* const task = inspection_->task();
    const std::size_t corners = topology(element.shape).corners;
    std::vector<double> values(max_corners * components_);
    const NodeMask missing =
        values_that_count(values, hierarchy.coarse_values(task, i, corners, values.data()));
    std::array<NodeKey, max_corners> own{};
    if (own_keys_) {
        hierarchy.corners(task, element.member->element, corners, own.data(), nullptr, nullptr);
    }
    for (std::size_t k = 0; k < corners; ++k) {
        element.corner[k].key = own_keys_ ? own[k] : coarse_key(coarse_.ids[k]);
        element.corner[k].value = values[k * components_];
    }
    for (std::size_t k = 0; k < corners; ++k) {
        show_node({.element = element,
                   .number = k,
                   .nodes = element.corners(),
                   .stencil = nullptr,
                   .has_value = (missing >> k & 1U) == 0,
                   .values = std::span(values).subspan(k * components_, components_),
                   .constrained = false,
                   .known = 0,
                   .is_new = false});
    }
    walk(element);
}

void CheckingWalk::walk(const CheckedElement& element) {
    show([&](GridLaw& law) { law.visit(element); });
    if (element.is_leaf()) return mark_seen(element);
    walk_children(element, *element.member->rule);
}

void CheckingWalk::walk_children(const CheckedElement& element, const Rule& rule) {
    Frame& frame = this->frame(element.level);
    put_corner_values(element, frame);
    const NodeMask missing = values_that_count(
        frame.value, inspection_->hierarchy().enter(inspection_->task(), element.member->element,
                                                    rule, rule.all(), frame.value.data(),
                                                    ~NodeMask{0}, frame.children));
    const std::vector<CheckedNode> nodes = nodes_of(element, rule);
    show([&](GridLaw& law) { law.visit(CheckedSplit{element, rule, frame.children, nodes}); });
    const std::size_t corners = element.corners().size();
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        show_node(
            {.element = element,
             .number = corners + n,
             .nodes = nodes,
             .stencil = &rule.new_nodes[n],
             .has_value = (missing >> n & 1U) == 0,
             .values = std::span(frame.value).subspan((corners + n) * components_, components_),
             .constrained = (element.member->constrained >> n & 1U) != 0,
             .known = 0,
             .is_new = false});
    }
    for (std::size_t k = 0; k < rule.children.size(); ++k) {
        if (!is_masked(frame.children, k)) walk(child(element, k, nodes));
    }
}

/// Puts the values at the corners into a frame, behind which those at new nodes have room.
void CheckingWalk::put_corner_values(const CheckedElement& element, Frame& frame) {
    frame.value.resize((max_corners + max_new_nodes) * components_);
    const KnownNodes& known = inspection_->nodes();
    auto out = frame.value.begin();
    for (const CheckedNode& corner : element.corners()) {
        const auto values = known.values(*known.find(corner.place), components_);
        out = std::copy(values.begin(), values.end(), out);
    }
}

/// The corners and the new nodes of an element, whose split is in its frame.
std::vector<CheckedNode> CheckingWalk::nodes_of(const CheckedElement& element,
                                                const Rule& rule) const {
    std::vector<CheckedNode> nodes(element.corners().begin(), element.corners().end());
    const std::size_t corners = nodes.size();
    const auto own =
        own_keys_ ? element.family->new_keys(*element.member) : std::span<const NodeKey>();
    const Frame& frame = frames_[static_cast<std::size_t>(element.level)];
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        nodes.push_back(make_node(rule.new_nodes[n], nodes));
        if (own_keys_) nodes.back().key = own[n];
        nodes.back().value = frame.value[(corners + n) * components_];
    }
    return nodes;
}

/// \param made but for `known` and `is_new`
void CheckingWalk::show_node(MadeNode made) {
    KnownNode fresh;
    fresh.place = made.node().place;
    fresh.key = made.node().key;
    fresh.element = made.element.step;
    fresh.constrained = made.constrained;
    std::tie(made.known, made.is_new) = inspection_->nodes().insert(fresh, made.values);
    show([&](GridLaw& law) { law.visit(made); });
}

void CheckingWalk::mark_seen(const CheckedElement& leaf) {
    if (leaf.member->hidden == Hidden::wholly) return;
    KnownNodes& known = inspection_->nodes();
    for (const CheckedNode& corner : leaf.corners()) known[*known.find(corner.place)].seen = true;
}

void CheckingWalk::walk_again(const CheckedElement& element) {
    show([&](GridLaw& law) { law.revisit(element); });
    if (element.is_leaf()) return;
    const Rule& rule = *element.member->rule;
    std::vector<CheckedNode> nodes(element.corners().begin(), element.corners().end());
    for (const Stencil& stencil : rule.new_nodes) nodes.push_back(make_node(stencil, nodes));
    Family& children = frame(element.level).children;
    inspection_->hierarchy().enter(inspection_->task(), element.member->element, rule, 0, nullptr,
                                   ~NodeMask{0}, children);
    for (std::size_t k = 0; k < rule.children.size(); ++k) {
        if (!is_masked(children, k)) walk_again(child(element, k, nodes));
    }
}

}  // namespace nestgrid::detail
