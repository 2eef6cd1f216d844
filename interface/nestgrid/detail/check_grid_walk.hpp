// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What check_grid asks below the coarse grid; included by check_grid_steps.hpp.
#pragma once

#include <limits>

#include <nestgrid/detail/check_grid_steps.hpp>

namespace nestgrid::detail {

/// As in "0.5 * (0, 0, 0) + 0.5 * (1, 0, 0)".
inline std::string stencil_text(std::span<const WeightedPoint> parents) {
    std::string sum;
    for (const auto& [weight, x] : parents) {
        std::array<char, 160> term;
        std::snprintf(term.data(), term.size(), "%s%g * (%g, %g, %g)", sum.empty() ? "" : " + ",
                      weight, x[0], x[1], x[2]);
        sum += term.data();
    }
    return sum;
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_ids() const {
    if (several_ids_at_.empty()) return;
    const Point& x = *several_ids_at_.begin();
    const std::string sentence =
        "coarse corners have different ids at " + std::to_string(several_ids_at_.size()) + " of " +
        std::to_string(id_at_.size()) + " places, such as (" + std::to_string(x[0]) + ", " +
        std::to_string(x[1]) + ", " + std::to_string(x[2]) +
        "): elements share no node there, as at a slit or where each counts its ids itself";
    if (options_.one_id_a_place) fail(Law::coarse_ids, sentence);
    if (options_.notes != nullptr) options_.notes->push_back(sentence);
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_rule(const State& s, const Rule& rule) {
    if (rules_.insert(&rule).second) {
        if (const auto violation = find_violation(rule)) {
            fail(Law::rule, *violation + " (in " + name(s.step) + ")");
        }
    }
    if (rule.parent != s.shape) {
        fail(Law::rule_shape, name(s.step) + " is a " + std::string(topology(s.shape).name) +
                                  ", but its rule '" + rule.name + "' refines a " +
                                  std::string(topology(rule.parent).name));
    }
    if (call_split(grid_, context_, s.element) != &rule) {
        fail(Law::split_repeats, "split() gives another rule when asked again in " + name(s.step));
    }
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::make_node(const Rule& rule, std::size_t n,
                                         std::vector<Corner>& nodes) {
    const Stencil& stencil = rule.new_nodes[n];
    Corner c;
    std::array<NodeKey, max_corners + max_new_nodes> keys;
    for (std::size_t k = 0; k < nodes.size(); ++k) keys[k] = nodes[k].derived;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        const Corner& p = nodes[stencil.parent[i]];
        for (std::size_t k = 0; k < max_corners; ++k) {
            c.weights[k] += stencil.weight[i] * p.weights[k];
        }
        c.position = c.position + stencil.weight[i] * p.position;
    }
    c.place = place_of(c.weights);
    c.derived = c.key = derived_key(stencil, keys.data());
    nodes.push_back(c);
}

/// \param n the last new node in `nodes`
template <class Grid, class Field>
void GridChecker<Grid, Field>::check_stencil(const State& s, const Rule& rule, std::size_t n,
                                             const std::vector<Corner>& nodes) {
    const Stencil& stencil = rule.new_nodes[n];
    Origin origin{0, s.step, parents_.size(), stencil.count};
    for (std::size_t i = 0; i < stencil.count; ++i) {
        origin.signature +=
            mix(nodes[stencil.parent[i]].key +
                static_cast<std::uint64_t>(std::llround(stencil.weight[i] * 0x1p40)));
    }
    const auto [known, is_new] = origins_.insert(nodes.back().place, origin);
    if (!is_new && known->signature == origin.signature) return;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        parents_.push_back({stencil.weight[i], nodes[stencil.parent[i]].position});
    }
    if (is_new) return;
    const auto text = [&](const Origin& of) {
        return stencil_text(std::span(parents_).subspan(of.first, of.count));
    };
    fail(Law::one_stencil, "one node has two stencils: " + text(origin) + " as node " +
                               std::to_string(nodes.size() - 1) + " of " + name(s.step) + ", and " +
                               text(*known) + " in " + name(known->element));
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::add_made(const Corner& node, const Stencil& stencil,
                                        const std::vector<Corner>& nodes) {
    Made made;
    made.place = node.place;
    made.derived = node.derived;
    made.coarse = coarse_number_;
    made.weights = node.weights;
    made.parents = stencil.count;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        made.parent[i] = nodes[stencil.parent[i]].place;
        made.weight[i] = stencil.weight[i];
    }
    made_.push_back(made);
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_own_keys(const State& s, std::span<const NodeKey> own) {
    for (std::size_t k = 0; k < own.size(); ++k) {
        if (own[k] != s.corner[k].key) {
            fail(Law::stable_key, "the key of corner " + std::to_string(k) + " of " + name(s.step) +
                                      " is not the one its father gave");
        }
    }
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_positions(const State& s) {
    if constexpr (may_offer<Grid>(Feature::own_positions)) {
        if (!offers(grid_, Feature::own_positions)) return;
        std::array<Point, max_corners> own;
        call_corner_positions(grid_, context_, s.element,
                              std::span<Point>(own.data(), topology(s.shape).corners));
        for (std::size_t k = 0; k < static_cast<std::size_t>(topology(s.shape).corners); ++k) {
            const std::string where = "corner " + std::to_string(k) + " of " + name(s.step);
            if (!(norm(own[k] - s.corner[k].position) <= options_.position_tolerance * size_)) {
                fail(Law::position, "the position of " + where + " is not that of eq. (1)");
            }
            Node* node = nodes_.find(s.corner[k].place);
            if (node->has_position && node->own_position != own[k]) {
                fail(Law::position, "one node has two positions: as " + where + " and elsewhere");
            }
            node->has_position = true;
            node->own_position = own[k];
        }
    }
}

template <class Grid, class Field>
bool GridChecker<Grid, Field>::deviates_from_mean(const Stencil& stencil,
                                                  const std::vector<Corner>& nodes,
                                                  Real value) const {
    double mean = 0;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        mean += stencil.weight[i] * static_cast<double>(nodes[stencil.parent[i]].value[0]);
    }
    const double tolerance =
        std::max<double>(options_.value_tolerance, 4 * std::numeric_limits<Real>::epsilon());
    return std::abs(mean - static_cast<double>(value)) > tolerance * largest_value_;
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_new_nodes(const State& s, const Rule& rule,
                                               std::vector<Corner>& nodes) {
    const std::size_t corners = nodes.size();
    const std::size_t count = rule.new_nodes.size();
    std::array<Real, max_new_nodes * components_> value;
    const NodeMask missing =
        count == 0 ? NodeMask{0}
                   : call_new_values(field_, context_, s.element, rule.all(),
                                     std::span<Real>(value.data(), count * components_));
    if (missing != 0) {
        fail(Law::value_present, "the field lacks a value at a new node of " + name(s.step));
    }
    NodeMask constrained = 0;
    if constexpr (may_offer<Grid>(Feature::constrained)) {
        if (offers(grid_, Feature::constrained)) {
            constrained = call_constrained(grid_, context_, s.element);
        }
    }
    std::array<NodeKey, max_new_nodes> own{};
    if constexpr (may_offer<Grid>(Feature::own_keys)) {
        if (own_keys_) {
            call_new_keys(grid_, context_, s.element, std::span<NodeKey>(own.data(), count));
        }
    }
    for (std::size_t n = 0; n < count; ++n) {
        make_node(rule, n, nodes);
        Corner& c = nodes.back();
        if (own_keys_) c.key = own[n];
        const Stencil& stencil = rule.new_nodes[n];
        check_stencil(s, rule, n, nodes);
        std::copy_n(value.begin() + static_cast<std::ptrdiff_t>(n * components_), components_,
                    c.value.begin());
        check_values(s.step, "new node", n, c.value);
        const bool deviates = deviates_from_mean(stencil, nodes, c.value[0]);
        if (nodes_.find(c.place) == nullptr) add_made(c, stencil, nodes);
        check_node(s, corners + n, c, (constrained >> n & 1U) != 0, deviates);
    }
    std::vector<NodeKey> derived;
    for (const Corner& c : nodes) derived.push_back(c.derived);
    const std::span<const NodeKey> all(derived);
    probe_.add_nodes(rule, all.first(corners), all.subspan(corners));
}

template <class Grid, class Field>
void GridChecker<Grid, Field>::walk(const State& s) {
    const auto corners = static_cast<std::size_t>(topology(s.shape).corners);
    if (s.level > options_.max_depth) {
        fail(Law::depth,
             name(s.step) + " lies deeper than " + std::to_string(options_.max_depth) + " levels");
    }
    if constexpr (may_offer<Grid>(Feature::own_keys)) {
        if (own_keys_) {
            std::array<NodeKey, max_corners> own{};
            call_corner_keys(grid_, context_, s.element, std::span<NodeKey>(own.data(), corners));
            check_own_keys(s, std::span<const NodeKey>(own).first(corners));
        }
    }
    check_positions(s);
    const Rule* rule = call_split(grid_, context_, s.element);
    const Hidden hidden = hidden_part(grid_, context_, s.element);
    if (rule == nullptr) {
        if (hidden == Hidden::partly) {
            fail(Law::hidden, name(s.step) + " is a leaf, but hidden in part");
        }
        if (hidden == Hidden::wholly) return;
        std::array<NodeKey, max_corners> keys{};
        for (std::size_t k = 0; k < corners; ++k) keys[k] = s.corner[k].derived;
        leaves_.push_back({s.shape, keys});
        return;
    }
    check_rule(s, *rule);

    std::vector<Corner> nodes(s.corner.begin(),
                              s.corner.begin() + static_cast<std::ptrdiff_t>(corners));
    check_new_nodes(s, *rule, nodes);
    std::vector<Element> children(rule->children.size());
    call_children(grid_, context_, s.element, std::span<Element>(children));
    for (const Element& child : children) {
        if (hidden != Hidden::partly && hidden_part(grid_, context_, child) != hidden) {
            fail(Law::hidden,
                 name(s.step) + " is " +
                     (hidden == Hidden::wholly ? "hidden, but not" : "not hidden, but") +
                     " all that lies below it");
        }
    }
    for (std::size_t k = 0; k < children.size(); ++k) {
        if constexpr (may_offer<Grid>(Feature::masked)) {
            if (offers(grid_, Feature::masked) && call_masked(grid_, context_, children[k])) {
                continue;
            }
        }
        const Child& child = rule->children[k];
        if (only_ != Shape::point && child.shape != only_) {
            fail(Law::rule_shape, "child " + std::to_string(k) + " of " + name(s.step) + " is a " +
                                      std::string(topology(child.shape).name) + promised_);
        }
        State next;
        next.element = children[k];
        next.shape = child.shape;
        next.level = s.level + 1;
        next.step = steps_.size();
        steps_.push_back({s.step, k});
        for (std::size_t i = 0; i < topology(child.shape).corners; ++i) {
            next.corner[i] = nodes[child.corner[i]];
        }
        walk(next);
    }
}

}  // namespace nestgrid::detail
