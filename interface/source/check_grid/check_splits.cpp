// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// check_grid: elements below the coarse grid, their rules, and the nodes that these make.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "grid_checker.hpp"

namespace nestgrid::detail {

void GridChecker::walk(const State& s) {
    if (s.level > options_->max_depth) {
        fail(Law::depth,
             name(s.step) + " lies deeper than " + std::to_string(options_->max_depth) + " levels");
    }
    check_own(s);
    const Rule* const rule = s.member->rule;
    rule_of_.push_back(rule);
    if (rule == nullptr) return check_leaf_state(s);
    check_rule(s, *rule);
    Frame& frame = this->frame(s.level);
    put_corner_values(s, frame);
    const NodeMask missing = values_that_count(
        frame.value, hierarchy_->enter(task_.get(), s.member->element, *rule, rule->all(),
                                       frame.value.data(), ~NodeMask{0}, frame.children));
    std::vector<Corner> nodes(s.corner.begin(), s.corner.begin() + topology(s.shape).corners);
    if ((missing & rule->all()) != 0) check_missing(s, *rule, missing, nodes);
    check_new_nodes(s, *rule, std::span(frame.value).subspan(nodes.size() * components_), nodes);
    check_hidden(s);
    check_presence(s);
    walk_children(s, nodes);
}

/// \param nodes the corners
void GridChecker::check_missing(const State& s, const Rule& rule, NodeMask missing,
                                std::vector<Corner> nodes) {
    const std::size_t corners = nodes.size();
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        make_node(rule, n, nodes);
        if ((missing >> n & 1U) == 0) continue;
        fail_unless_hidden(nodes[corners + n].place, Law::value_present,
                           "the field lacks a value at a new node of " + name(s.step));
    }
}

/// Puts the values at the corners into a frame, behind which those at new nodes have room.
void GridChecker::put_corner_values(const State& s, Frame& frame) const {
    frame.value.resize((max_corners + max_new_nodes) * components_);
    for (std::size_t k = 0; k < topology(s.shape).corners; ++k) {
        const Node& node = *nodes_.find(s.corner[k].place);
        std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(node.first), components_,
                    frame.value.begin() + static_cast<std::ptrdiff_t>(k * components_));
    }
}

void GridChecker::walk_children(const State& s, const std::vector<Corner>& nodes) {
    const Rule& rule = *s.member->rule;
    const Shape only = hierarchy_->facts().only_shape;
    for (std::size_t k = 0; k < rule.children.size(); ++k) {
        if (is_masked(frame(s.level).children, k)) continue;
        const Shape shape = rule.children[k].shape;
        if (only != Shape::point && shape != only) {
            fail(Law::rule_shape, "child " + std::to_string(k) + " of " + name(s.step) + " is a " +
                                      std::string(topology(shape).name) + promise());
        }
        walk(child_state(s, k, nodes));
    }
}

/// \param nodes corners and new nodes of the father s, whose split is in its frame
auto GridChecker::child_state(const State& s, std::size_t child, const std::vector<Corner>& nodes)
    -> State {
    const Family& family = frame(s.level).children;
    const Child& as = s.member->rule->children[child];
    State next{&family.members[child], &family, as.shape, steps_.size(), s.level + 1, {}};
    steps_.push_back({s.step, child});
    for (std::size_t i = 0; i < topology(as.shape).corners; ++i) {
        next.corner[i] = nodes[as.corner[i]];
    }
    return next;
}

void GridChecker::check_leaf_state(const State& s) {
    if (s.member->hidden == Hidden::partly) {
        fail(Law::hidden, name(s.step) + " is a leaf, but hidden in part");
    }
    if (s.member->presence != Presence::here) {
        fail(Law::presence, name(s.step) + " is a leaf, but here in part");
    }
    if (s.member->hidden == Hidden::wholly) return;
    std::array<NodeKey, max_corners> keys{};
    for (std::size_t k = 0; k < topology(s.shape).corners; ++k) {
        keys[k] = s.corner[k].key;
        seen_.insert(s.corner[k].place, true);
    }
    leaves_.push_back({s.shape, keys});
}

/// Compares an element with its children, which are in its frame.
void GridChecker::check_hidden(const State& s) {
    const Hidden hidden = s.member->hidden;
    if (hidden == Hidden::partly) return;
    const Family& children = frame(s.level).children;
    for (std::size_t k = 0; k < s.member->rule->children.size(); ++k) {
        if (is_masked(children, k) || children.members[k].hidden == hidden) continue;
        fail(Law::hidden, name(s.step) + " is " +
                              (hidden == Hidden::wholly ? "hidden, but not" : "not hidden, but") +
                              " all that lies below it");
    }
}

/// The values at nodes of which no leaf is here come from other processes (DistributedField): where
/// parts may be elsewhere, no value counts.
/// \return the nodes without a value
NodeMask GridChecker::values_that_count(std::span<double> values, NodeMask missing) const {
    if (!hierarchy_->offers(Feature::presence)) return missing;
    std::ranges::fill(values, 0.0);
    return 0;
}

/// Compares an element that is not elsewhere with its children, which are in its frame.
void GridChecker::check_presence(const State& s) {
    const Presence presence = s.member->presence;
    const Family& children = frame(s.level).children;
    const std::size_t count = s.member->rule->children.size();
    std::size_t here = 0;
    std::size_t elsewhere = 0;
    for (std::size_t k = 0; k < count; ++k) {
        here += children.members[k].presence == Presence::here ? 1 : 0;
        elsewhere += children.members[k].presence == Presence::elsewhere ? 1 : 0;
    }
    const bool has_first = children.members[0].presence <= Presence::partly_first;
    const char* wrong = nullptr;
    if (presence == Presence::here && here < count) {
        wrong = " is here, but not all that lies below it";
    } else if (elsewhere == count) {
        wrong = " is here in part, but all that lies below it is elsewhere";
    } else if (presence != Presence::here && here == count) {
        wrong = " is here in part, but all that lies below it is here";
    } else if (presence == Presence::partly_first && !has_first) {
        wrong = " has its first leaf here, but its first child has not";
    } else if (presence == Presence::partly && has_first) {
        wrong = " does not have its first leaf here, but its first child has";
    }
    if (wrong != nullptr) fail(Law::presence, name(s.step) + wrong);
}

void GridChecker::check_rule(const State& s, const Rule& rule) {
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
}

/// Compares what the grid itself says of the corners of an element with what its father said.
void GridChecker::check_own(const State& s) {
    const bool own_positions = hierarchy_->offers(Feature::own_positions);
    if (!own_keys_ && !own_positions) return;
    std::array<NodeKey, max_corners> key{};
    std::array<Point, max_corners> position{};
    const std::size_t corners = topology(s.shape).corners;
    hierarchy_->corners(task_.get(), s.member->element, corners, own_keys_ ? key.data() : nullptr,
                        own_positions ? position.data() : nullptr, nullptr);
    for (std::size_t k = 0; k < corners; ++k) {
        const Corner& c = s.corner[k];
        const auto where = [&] { return "corner " + std::to_string(k) + " of " + name(s.step); };
        if (own_keys_ && key[k] != c.key) {
            fail(Law::stable_key, "the key of " + where() + " is not the one its father gave");
        }
        if (!own_positions) continue;
        if (!(norm(position[k] - c.position) <= options_->position_tolerance * size_)) {
            fail(Law::position, "the position of " + where() + " is not that of eq. (1)");
        }
        Node& node = *nodes_.find(c.place);
        if (node.has_position && node.own_position != position[k]) {
            fail(Law::position, "one node has two positions: as " + where() + " and elsewhere");
        }
        node.has_position = true;
        node.own_position = position[k];
    }
}

/// Adds new node n of a rule to the nodes before it.
void GridChecker::make_node(const Rule& rule, std::size_t n, std::vector<Corner>& nodes) const {
    const Stencil& stencil = rule.new_nodes[n];
    Corner c;
    std::array<NodeKey, max_corners + max_new_nodes> keys;
    for (std::size_t k = 0; k < nodes.size(); ++k) keys[k] = nodes[k].key;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        const Corner& p = nodes[stencil.parent[i]];
        for (std::size_t k = 0; k < max_corners; ++k) {
            c.weights[k] += stencil.weight[i] * p.weights[k];
        }
        c.position = c.position + stencil.weight[i] * p.position;
    }
    c.place = place_of(c.weights);
    c.key = derived_key(stencil, keys.data());
    nodes.push_back(c);
}

/// \param values of all new nodes, and perhaps more
/// \param nodes the corners, to which the new nodes are added
void GridChecker::check_new_nodes(const State& s, const Rule& rule, std::span<const double> values,
                                  std::vector<Corner>& nodes) {
    const std::size_t corners = nodes.size();
    const std::size_t count = rule.new_nodes.size();
    const NodeMask constrained = s.member->constrained;
    const auto own = own_keys_ ? s.family->new_keys(*s.member) : std::span<const NodeKey>();
    for (std::size_t n = 0; n < count; ++n) {
        make_node(rule, n, nodes);
        Corner& c = nodes.back();
        if (own_keys_) c.key = own[n];
        check_stencil(s, rule, n, nodes);
        const auto value = values.subspan(n * components_, components_);
        c.value = value[0];
        check_values(s.step, "new node", n, c.place, value);
        const Stencil& stencil = rule.new_nodes[n];
        if (nodes_.find(c.place) == nullptr) add_made(c, stencil, nodes);
        check_node(s, corners + n, c, value, (constrained >> n & 1U) != 0,
                   deviates_from_mean(stencil, nodes));
    }
    std::vector<NodeKey> keys;
    for (const Corner& c : nodes) keys.push_back(c.key);
    const std::span<const NodeKey> all(keys);
    probe_.add_nodes(rule, all.first(corners), all.subspan(corners));
}

/// \param nodes the last one is new node n
void GridChecker::check_stencil(const State& s, const Rule& rule, std::size_t n,
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
    // As in "0.5 * (0, 0, 0) + 0.5 * (1, 0, 0)".
    const auto text = [&](const Origin& of) {
        std::string sum;
        for (const auto& [weight, x] : std::span(parents_).subspan(of.first, of.count)) {
            std::array<char, 160> term;
            std::snprintf(term.data(), term.size(), "%s%g * (%g, %g, %g)", sum.empty() ? "" : " + ",
                          weight, x[0], x[1], x[2]);
            sum += term.data();
        }
        return sum;
    };
    const std::string sentence = "one node has two stencils: " + text(origin) + " as node " +
                                 std::to_string(nodes.size() - 1) + " of " + name(s.step) +
                                 ", and " + text(*known) + " in " + name(known->element);
    if (!hierarchy_->offers(Feature::hanging_parents)) fail(Law::one_stencil, sentence);
    two_stencils_.try_emplace(nodes.back().place, sentence);
}

/// Whether the value of the last node is not its interpolant.
bool GridChecker::deviates_from_mean(const Stencil& stencil,
                                     const std::vector<Corner>& nodes) const {
    double mean = 0;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        mean += stencil.weight[i] * nodes[stencil.parent[i]].value;
    }
    return deviates(mean, nodes.back().value);
}

/// Whether the value at a node is not the mean of its parents.
bool GridChecker::deviates(double mean, double value) const {
    const double tolerance = std::max(options_->value_tolerance, 4 * epsilon_);
    return std::abs(mean - value) > tolerance * largest_value_;
}

void GridChecker::add_made(const Corner& node, const Stencil& stencil,
                           const std::vector<Corner>& nodes) {
    Made made;
    made.place = node.place;
    made.key = node.key;
    made.coarse = coarse_number_;
    made.weights = node.weights;
    made.parents = stencil.count;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        made.parent[i] = nodes[stencil.parent[i]].place;
        made.weight[i] = stencil.weight[i];
    }
    made_.push_back(made);
}

}  // namespace nestgrid::detail
