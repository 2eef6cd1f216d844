// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of the traversal; included by traversal.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <optional>

#include <nestgrid/key_table.hpp>
#include <nestgrid/traversal.hpp>

namespace nestgrid {

template <class Grid, class Field, Needs needs>
std::vector<std::uint8_t> Traversal<Grid, Field, needs>::coarse_boundary(const Grid& grid) {
    struct Use {
        std::size_t element;
        std::uint8_t face;
        bool once;
    };
    Context<Grid> context = make_context(grid);
    std::vector<std::uint8_t> boundary(grid.coarse_count(), 0);
    KeyTable<NodeKey, Use> faces;
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        const auto coarse = detail::call_coarse(grid, context, i);
        const Topology& t = topology(coarse.shape);
        if (t.dimension != Grid::dimension) {
            throw GridError("coarse element " + std::to_string(i) + " is a " + std::string(t.name) +
                            ", but the grid has dimension " + std::to_string(Grid::dimension));
        }
        for (std::uint8_t f = 0; f < t.faces; ++f) {
            NodeKey sum = 0;
            for (std::size_t k = 0; k < t.face[f].corners; ++k) {
                sum += coarse_key(coarse.ids[t.face[f].corner[k]]);
            }
            const auto [use, is_new] = faces.insert(mean_key(sum, t.face[f].corners), {i, f, true});
            if (!is_new) use->once = false;
        }
    }
    faces.for_each([&](const NodeKey&, const Use& use) {
        if (use.once) boundary[use.element] |= static_cast<std::uint8_t>(1U << use.face);
    });
    return boundary;
}

template <class Grid, class Field, Needs needs>
bool Traversal<Grid, Field, needs>::make_coarse(std::size_t i, State& s) const {
    const CoarseElement<Element> coarse = detail::call_coarse(*grid_, *s.context, i);
    s.element = coarse.element;
    s.coarse = i;
    s.father = nullptr;
    s.level = 0;
    s.shape = coarse.shape;
    s.orientation = coarse.orientation;
    s.boundary = boundary_.empty() ? std::uint8_t{0} : boundary_[i];
    s.interpolated = 0;
    s.made_by = nullptr;
    s.child = 0;
    if constexpr (needs.closed) {
        s.closed.any = false;
        s.path = detail::mix(static_cast<NodeKey>(i));
    }
    if (constexpr Shape only = detail::only_shape<Grid>();
        only != Shape::point && s.shape != only) {
        throw GridError("coarse element " + std::to_string(i) + " is a " +
                        std::string(topology(s.shape).name) + ", but the grid says that all are " +
                        std::string(topology(only).name) + "s");
    }
    if constexpr (may_offer<Grid>(Feature::masked)) {
        if (offers(*grid_, Feature::masked) && detail::call_masked(*grid_, *s.context, s.element)) {
            return false;
        }
    }
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const NodeMask missing = detail::call_coarse_values(
        *field_, *s.context, i, std::span<Real>(s.value.data(), corners * State::components));
    if (missing != 0) {
        throw GridError("the field has no value at corner " +
                        std::to_string(std::countr_zero(missing)) + " of coarse element " +
                        std::to_string(i));
    }
    if constexpr (State::carries_keys) {
        for (std::size_t k = 0; k < corners; ++k) s.key[k] = coarse_key(coarse.ids[k]);
        if constexpr (may_offer<Grid>(Feature::own_keys)) {
            if (own_keys_) {
                detail::call_corner_keys(*grid_, *s.context, s.element,
                                         exact(s, std::span<NodeKey>(s.key)));
            }
        }
    }
    if constexpr (State::carries_positions) {
        std::copy_n(coarse.corners.begin(), corners, s.position.begin());
    }
    return true;
}

template <class Grid, class Field, Needs needs>
template <class Visitor>
void Traversal<Grid, Field, needs>::inspect(const State& s, const Rule* rule,
                                            Visitor& visitor) const {
    std::array<NodeKey,
               needs.keys || !detail::by_heart<Grid>(Feature::constrained) ? node_capacity_ : 1>
        keys;
    const Hidden hidden = hidden_part(*grid_, *s.context, s.element);
    if (hidden == Hidden::wholly && !detail::sees_hidden(visitor)) return;
    Split split;
    split.rule = rule;
    if (rule == nullptr) {
        if (visitor.inspect(s, split).visit != Visit::skip) visitor.extract(s);
        return;
    }
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const auto count = static_cast<std::size_t>(rule->new_node_count());
    if constexpr (needs.keys) {
        if constexpr (State::carries_keys) std::copy_n(s.key.begin(), corners, keys.begin());
        bool own = false;
        if constexpr (may_offer<Grid>(Feature::own_keys)) {
            own = own_keys_;
            if (own) {
                detail::call_new_keys(*grid_, *s.context, s.element,
                                      std::span<NodeKey>(keys.data() + corners, count));
            }
        }
        if constexpr (State::carries_keys) {
            for (std::size_t n = 0; n < count && !own; ++n) {
                keys[corners + n] = derived_key(rule->new_nodes[n], keys.data());
            }
        }
        split.keys = std::span<const NodeKey>(keys.data() + corners, count);
    }
    if constexpr (may_offer<Grid>(Feature::constrained)) {
        if (constrained_) {
            split.constrained = detail::call_constrained(*grid_, *s.context, s.element);
        }
    }
    if constexpr (needs.keys) {
        if (!constrained_ && hanging_ != nullptr) split.constrained = hanging_->mask(split.keys);
    }
    if constexpr (may_offer<Grid>(Feature::outside)) {
        if (offers(*grid_, Feature::outside)) {
            split.outside = detail::call_outside(*grid_, *s.context, s.element);
        }
    }
    Decision decision;
    if (count > 0) decision = visitor.inspect(s, split);
    if (decision.visit == Visit::skip) return;
    if (decision.visit == Visit::stop && hidden != Hidden::partly) {
        visitor.extract(s);
    } else {
        descend(s, split, decision.interpolated, keys.data(), visitor);
    }
}

template <class Grid, class Field, Needs needs>
template <class Visitor>
void Traversal<Grid, Field, needs>::descend(const State& s, const Split& split,
                                            NodeMask interpolated, NodeKey* keys,
                                            Visitor& visitor) const {
    const Rule& rule = *split.rule;
    Nodes nodes;
    nodes.interpolated = interpolated;
    nodes.mean = interpolated | split.constrained;
    nodes.key = keys;
    project(s, split, interpolated, nodes.value.data());
    if constexpr (requires { visitor.made(s, split, std::span<const Real>()); }) {
        const std::size_t count =
            static_cast<std::size_t>(s.corner_count()) + rule.new_nodes.size();
        if (!rule.new_nodes.empty()) {
            visitor.made(s, split,
                         std::span<const Real>(nodes.value).first(count * State::components));
        }
    }
    if constexpr (State::carries_positions) {
        if (!own_positions_) project_positions(s, split, interpolated, nodes.position.data());
    }
    if constexpr (needs.closed) {
        if (s.closed.any || (nodes.mean & rule.all()) != 0 || rule.divides_bare_faces) {
            return close_and_enter(s, rule, nodes, visitor);
        }
    }
    enter(s, rule, nodes, nullptr, visitor);
}

template <class Grid, class Field, Needs needs>
template <class Visitor>
void Traversal<Grid, Field, needs>::enter(const State& s, const Rule& rule, const Nodes& nodes,
                                          [[maybe_unused]] const Parts* parts,
                                          Visitor& visitor) const {
    constexpr std::size_t c_count = State::components;
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const std::size_t children = rule.children.size();
    std::array<Element, detail::child_capacity<Grid>()> elements;
    detail::call_children(*grid_, *s.context, s.element,
                          std::span<Element>(elements.data(), children));
    const bool any_interpolated = s.interpolated != 0 || nodes.interpolated != 0;
    bool passes_over_leaves = false;
    if constexpr (requires { visitor.passes_over_leaves(); }) {
        passes_over_leaves = parts == nullptr && visitor.passes_over_leaves();
    }
    bool looks_ahead = false;
    if constexpr (requires { visitor.looks_ahead(); }) looks_ahead = visitor.looks_ahead();
    std::optional<NodeMask> of_interest;
    const NodeMask wanted = detail::children_to_enter(visitor, s);
    for (std::size_t c = 0; c < children; ++c) {
        if ((wanted >> c & 1U) == 0) continue;
        const Child& child = rule.children[c];
        if constexpr (may_offer<Grid>(Feature::masked)) {
            if (offers(*grid_, Feature::masked) &&
                detail::call_masked(*grid_, *s.context, elements[c])) {
                continue;
            }
        }
        const Rule* const split = detail::call_split(*grid_, *s.context, elements[c]);
        if (passes_over_leaves && split == nullptr) continue;
        const bool is_known = looks_ahead && split == nullptr;
        if constexpr (requires { visitor.looks_ahead(); }) {
            if (is_known) {
                if (!of_interest) of_interest = visitor.leaves_of_interest(rule, nodes.value);
                const bool is_shown =
                    detail::sees_hidden(visitor) || !is_hidden(*grid_, *s.context, elements[c]);
                const bool enters = (*of_interest >> c & 1U) != 0;
                if (is_shown) visitor.count_leaf(enters);
                if (!is_shown || !enters) continue;
            }
        }
        State k;
        k.element = elements[c];
        k.context = s.context;
        k.coarse = s.coarse;
        k.father = &s;
        k.level = s.level + 1;
        k.shape = child.shape;
        k.orientation = static_cast<std::int8_t>(s.orientation * child.orientation);
        k.made_by = &rule;
        k.child = static_cast<std::uint8_t>(c);
        k.interpolated = 0;
        k.boundary = 0;
        const Topology& t = topology(child.shape);
        for (std::size_t f = 0; s.boundary != 0 && f < t.faces; ++f) {
            const std::uint8_t g = child.parent_face[f];
            if (g != no_face && (s.boundary >> g & 1U) != 0) {
                k.boundary |= static_cast<std::uint8_t>(1U << f);
            }
        }
        const auto child_corners = static_cast<std::size_t>(k.corner_count());
        for (std::size_t i = 0; i < child_corners; ++i) {
            const std::size_t n = child.corner[i];
            for (std::size_t q = 0; q < c_count; ++q) {
                k.value[i * c_count + q] = nodes.value[n * c_count + q];
            }
            if constexpr (State::carries_keys) k.key[i] = nodes.key[n];
            if constexpr (State::carries_positions) k.position[i] = nodes.position[n];
        }
        for (std::size_t i = 0; any_interpolated && i < child_corners; ++i) {
            const std::size_t n = child.corner[i];
            NodeMask flag = NodeMask{s.interpolated} >> n;
            if constexpr (node_capacity_ <= 64) {
                flag = (s.interpolated | nodes.interpolated << corners) >> n;
            } else if (n >= corners) {
                flag = nodes.interpolated >> (n - corners);
            }
            k.interpolated |= static_cast<std::uint8_t>((flag & 1U) << i);
        }
        if constexpr (needs.closed) {
            k.path = s.path * NodeKey{0x9e3779b97f4a7c15ULL} + c + 1U;
            k.closed.any = false;
            if (parts != nullptr) k.closed = parts->of(child);
        }
        if (is_known) {
            visitor.extract(k);
        } else {
            inspect(k, split, visitor);
        }
    }
}

}  // namespace nestgrid

#include <nestgrid/closed_steps.hpp>
#include <nestgrid/traversal_nodes.hpp>
