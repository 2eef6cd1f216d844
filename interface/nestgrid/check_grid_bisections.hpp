// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whether what is known of bisections (known_bisection.hpp) is what the grid says; included by
// check_grid_steps.hpp.
#pragma once

#include <nestgrid/check_grid_steps.hpp>

namespace nestgrid::detail {

template <class Grid, class Field>
void GridChecker<Grid, Field>::check_known_bisection([[maybe_unused]] const State& s,
                                                     [[maybe_unused]] const Rule* rule) {
    if constexpr (KnowsBisections<Grid, Field>) {
        check_known_bisection(grid_, field_, s, rule);
    } else if constexpr (requires { field_.is_told_bisections(grid_); }) {
        if (!field_.is_told_bisections(grid_)) return;
        check_known_bisection(grid_.told_bisections(context_), field_.told_values(), s, rule);
    }
}

/// \param known what is told of the grid, \param values of the field
template <class Grid, class Field>
template <class Known, class Nodal>
void GridChecker<Grid, Field>::check_known_bisection(const Known& known, const Nodal& values,
                                                     const State& s, const Rule* rule) {
    constexpr std::size_t corners = static_cast<std::size_t>(Grid::dimension) + 1;
    const auto demand = [&](bool holds, const char* what) {
        if (!holds) {
            fail(Law::known_bisection,
                 std::string(what) + " is not what is known of bisections, in " + name(s.step));
        }
    };
    const std::size_t number = known.bisection(s.element);
    demand(number < Known::bisections.size(), "the number of the bisection");
    const KnownBisection& bisection = Known::bisections[number];
    const auto n = known.nodes(s.element);
    for (std::size_t k = 0; k < corners; ++k) {
        demand(known.key(n[k]) == s.corner[k].key, "the node at a corner");
    }
    demand(known.nodes(known.element(number, n)) == n, "the element of some nodes");
    std::array<Point, corners> x;
    call_corner_positions(grid_, context_, s.element, std::span<Point>(x));
    for (std::size_t k = 0; k < corners; ++k) {
        demand(known.position(n[k]) == x[k], "the position of a node");
    }
    const auto a = n[bisection.parent[0]];
    const auto b = n[bisection.parent[1]];
    demand(known.halved(a, b) == (rule != nullptr), "whether the element is split");
    if constexpr (AnswersInRows<Known>) check_rows(known, values, n, a, b, demand);
    if (rule == nullptr) return;
    const auto is_whole = [&](const auto& nodes) {
        if constexpr (requires { known.whole(nodes); }) {
            if (known.whole(nodes)) return true;
        }
        return known.whole();
    };
    if constexpr (may_offer<Grid>(Feature::outside)) {
        const bool none =
            !offers(grid_, Feature::outside) || call_outside(grid_, context_, s.element) == 0;
        demand(none || !is_whole(n), "what is whole");
    }
    if constexpr (std::is_same_v<Known, Grid>) demand(&known.rule(number) == rule, "the rule");
    const auto z = known.middle(a, b);
    NodeKey key{};
    call_new_keys(grid_, context_, s.element, std::span<NodeKey>(&key, 1));
    demand(known.key(z) == key, "the new node");
    Real value{};
    call_new_values(field_, context_, s.element, NodeMask{1}, std::span<Real>(&value, 1));
    demand(values.template value_at<false>(z, key) == value, "the value at the new node");
    if (known.whole()) {
        demand(values.template value_at<true>(z, key) == value, "the value at the new node");
    }
    if constexpr (!AnswersInRows<Known>) check_packs(known, a, b, z, demand);
    if constexpr (KnowsBlocks<Known>) {
        if (number + 1 == Known::bisections.size()) {
            std::size_t split = 0;
            const std::size_t ends = count_block_ends(s.element, Known::block_height, split);
            demand(ends == std::size_t{1} << Known::block_height && (split == 0 || split == ends),
                   "which elements of a block are split");
        }
    }
    std::array<Element, 2> children;
    call_children(grid_, context_, s.element, std::span<Element>(children));
    for (std::size_t c = 0; c < 2; ++c) {
        const KnownBisection::Half& half = bisection.child[c];
        demand(known.bisection(children[c]) == half.bisection, "a child's bisection");
        demand(rule->children[c].orientation == half.orientation, "a child's orientation");
        const auto of_child = known.nodes(children[c]);
        for (std::size_t k = 0; k < corners; ++k) {
            demand(of_child[k] == (half.corner[k] == 4 ? z : n[half.corner[k]]), "a child's node");
        }
        bool whole = is_whole(of_child);
        if constexpr (may_offer<Grid>(Feature::masked)) {
            whole = whole &&
                    !(offers(grid_, Feature::masked) && call_masked(grid_, context_, children[c]));
        }
        demand(whole || !is_whole(n), "what is whole");
    }
}

/// Whether several at once are what they are one by one: middles of nodes and of keys, positions.
template <class Grid, class Field>
template <class Known, class Handle, class Demand>
void GridChecker<Grid, Field>::check_packs(const Known& known, Handle a, Handle b, Handle z,
                                           const Demand& demand) {
    const auto halves_packs = [&](auto from, auto to, auto between, const auto& middle) {
        using T = decltype(from);
        if constexpr (Packable<T>) {
            if constexpr (std::is_invocable_v<decltype(middle), Pack<T>, Pack<T>>) {
                const auto all = middle(Pack<T>::all(from), Pack<T>::all(to)).numbers();
                return std::ranges::count(all, between) == std::ssize(all);
            }
        }
        return true;
    };
    demand(halves_packs(a, b, z,
                        [&](const auto& from, const auto& to) -> decltype(known.middle(from, to)) {
                            return known.middle(from, to);
                        }),
           "the middle of a pack of nodes");
    if constexpr (PacksPositions<Known>) {
        std::array<Handle, doubles_at_once> nodes;
        for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = i % 2 == 0 ? a : z;
        known.template with_packed_positions<doubles_at_once>([&](const auto& positions) {
            const auto x = positions(Pack<Handle, doubles_at_once>::load(nodes.data()));
            for (std::size_t i = 0; i < nodes.size(); ++i) {
                const Point one{x[0].numbers()[i], x[1].numbers()[i], x[2].numbers()[i]};
                demand(one == known.position(nodes[i]), "the position of a pack of nodes");
            }
        });
    }
    if constexpr (KnowsBlocks<Known>) {
        const NodeKey key = known.key(z);
        demand(known.middle_key(known.key(a), known.key(b)) == key, "the key between two");
        demand(halves_packs(
                   known.key(a), known.key(b), key,
                   [&](const auto& from, const auto& to) -> decltype(known.middle_key(from, to)) {
                       return known.middle_key(from, to);
                   }),
               "the middle of a pack of keys");
    }
}

/// Whether a row of nodes is answered as they are one by one.
/// \param n at the corners, \param a, \param b those of them that are halved where one is
template <class Grid, class Field>
template <class Known, class Nodal, class Handles, class Handle, class Demand>
void GridChecker<Grid, Field>::check_rows(const Known& known, const Nodal& values, const Handles& n,
                                          Handle a, Handle b, const Demand& demand) {
    std::array<NodeKey, std::tuple_size_v<Handles>> keys;
    std::array<Point, std::tuple_size_v<Handles>> x;
    std::array<Real, std::tuple_size_v<Handles>> u;
    known.keys(n, keys);
    for (std::size_t i = 0; i < n.size(); ++i) {
        demand(keys[i] == known.key(n[i]), "a key in a row");
    }
    known.positions(n, x);
    values.values_at(n, keys, u);  // of keys that were found right
    for (std::size_t i = 0; i < n.size(); ++i) {
        demand(x[i] == known.position(n[i]), "a position in a row");
        demand(u[i] == values.template value_at<true>(n[i], keys[i]), "a value in a row");
    }
    // In either direction, and the answers in the place of the question.
    std::array<Handle, 3> between{a, b, a};
    const std::array<Handle, 3> to{b, a, b};
    known.perhaps_middles(between, to, between);
    const Handle z = known.halved(a, b) ? known.middle(a, b) : Known::no_node;
    demand(std::ranges::count(between, z) == std::ssize(between), "a middle in a row");
}

/// How many elements there are so many levels below one, and how many of them are split.
template <class Grid, class Field>
std::size_t GridChecker<Grid, Field>::count_block_ends(const Element& e, std::size_t height,
                                                       std::size_t& split) {
    const Rule* rule = call_split(grid_, context_, e);
    if (height == 0) {
        split += rule != nullptr ? 1U : 0U;
        return 1;
    }
    if (rule == nullptr) return 0;
    std::array<Element, max_children> children;
    const std::span<Element> all = std::span(children).first(rule->children.size());
    call_children(grid_, context_, e, all);
    std::size_t count = 0;
    for (const Element& child : all) count += count_block_ends(child, height - 1, split);
    return count;
}

}  // namespace nestgrid::detail
