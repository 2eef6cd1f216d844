// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Checks that the bisections a grid tells (known_bisection.hpp) are those of split(), children()
// and its other operations.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include <nestgrid/detail/operations.hpp>
#include <nestgrid/detail/pack.hpp>
#include <patches/known_bisection.hpp>

namespace nestgrid::engine {

/// Walks a grid and compares. Requires that the grid keeps the contract (check_grid.hpp) and has
/// own keys and own positions.
/// \tparam Known the grid itself, or its ToldBisections
/// \tparam Values the field itself, or its ToldValues
template <class Grid, class Field, class Known, class Values>
class BisectionCheck {
public:
    using Element = ElementOf<Grid>;
    using Real = typename Field::value_type;

    BisectionCheck(const Grid& grid, const Field& field, const Known& known, const Values& values,
                   Context<Grid>& context)
        : grid_{grid}, field_{field}, known_{known}, values_{values}, context_{context} {}

    /// Compares all elements. \return the first difference as a sentence
    std::optional<std::string> run() {
        try {
            for (std::size_t i = 0; i < grid_.coarse_count(); ++i) {
                name_ = std::to_string(i);
                walk(detail::call_coarse(grid_, context_, i).element);
            }
        } catch (const Found& found) {
            return found.sentence;
        }
        return std::nullopt;
    }

private:
    static constexpr std::size_t corners_ = static_cast<std::size_t>(Grid::dimension) + 1;
    using Node = typename Known::Node;
    using Nodes = std::array<Node, corners_>;

    struct Found {
        std::string sentence;
    };

    void demand(bool holds, const char* what) const {
        if (holds) return;
        throw Found{std::string(what) + " is not what is known of bisections, in element " + name_};
    }

    void walk(const Element& e) {
        const Rule* rule = detail::call_split(grid_, context_, e);
        check(e, rule);
        if (rule == nullptr) return;
        std::array<Element, 2> children;
        detail::call_children(grid_, context_, e, std::span<Element>(children));
        const std::string name = name_;
        for (std::size_t c = 0; c < 2; ++c) {
            if (is_masked(children[c])) continue;
            name_ = name + "/" + std::to_string(c);
            walk(children[c]);
        }
        name_ = name;
    }

    void check(const Element& e, const Rule* rule) {
        const std::size_t number = known_.bisection(e);
        demand(number < Known::bisections.size(), "the number of the bisection");
        const KnownBisection& bisection = Known::bisections[number];
        const Nodes n = known_.nodes(e);
        check_corners(e, number, n);
        const Node a = n[bisection.parent[0]];
        const Node b = n[bisection.parent[1]];
        demand(known_.halved(a, b) == (rule != nullptr), "whether the element is split");
        if constexpr (AnswersInRows<Known>) {
            check_rows(n, a, b);
            check_gradients(e, n);
        }
        if (rule == nullptr) return;
        if constexpr (may_offer<Grid>(Feature::outside)) {
            const bool none =
                !offers(grid_, Feature::outside) || detail::call_outside(grid_, context_, e) == 0;
            demand(none || !is_whole(n), "what is whole");
        }
        if constexpr (std::is_same_v<Known, Grid>) {
            demand(&known_.rule(number) == rule, "the rule");
        }
        const Node z = known_.middle(a, b);
        check_new_node(e, z);
        if constexpr (!AnswersInRows<Known>) check_packs(a, b, z);
        if constexpr (KnowsPatches<Known>) {
            if (number + 1 == Known::bisections.size()) check_patch(e);
        }
        check_children(e, *rule, bisection, n, z);
    }

    void check_corners(const Element& e, std::size_t number, const Nodes& n) {
        std::array<NodeKey, corners_> keys;
        detail::call_corner_keys(grid_, context_, e, std::span<NodeKey>(keys));
        for (std::size_t k = 0; k < corners_; ++k) {
            demand(known_.key(n[k]) == keys[k], "the node at a corner");
        }
        demand(known_.nodes(known_.element(number, n)) == n, "the element of some nodes");
        std::array<Point, corners_> x;
        detail::call_corner_positions(grid_, context_, e, std::span<Point>(x));
        for (std::size_t k = 0; k < corners_; ++k) {
            demand(known_.position(n[k]) == x[k], "the position of a node");
        }
    }

    void check_new_node(const Element& e, Node z) {
        NodeKey key{};
        detail::call_new_keys(grid_, context_, e, std::span<NodeKey>(&key, 1));
        demand(known_.key(z) == key, "the new node");
        Real value{};
        detail::call_new_values(field_, context_, e, NodeMask{1}, std::span<Real>(&value, 1));
        demand(values_.template value_at<false>(z, key) == value, "the value at the new node");
        if (!known_.whole()) return;
        demand(values_.template value_at<true>(z, key) == value, "the value at the new node");
    }

    void check_patch(const Element& e) {
        std::size_t split = 0;
        const std::size_t ends = count_patch_ends(e, Known::patch_height, split);
        demand(ends == std::size_t{1} << Known::patch_height && (split == 0 || split == ends),
               "which elements of a patch are split");
    }

    void check_children(const Element& e, const Rule& rule, const KnownBisection& bisection,
                        const Nodes& n, Node z) {
        std::array<Element, 2> children;
        detail::call_children(grid_, context_, e, std::span<Element>(children));
        for (std::size_t c = 0; c < 2; ++c) {
            const KnownBisection::Half& half = bisection.child[c];
            demand(known_.bisection(children[c]) == half.bisection, "a child's bisection");
            demand(rule.children[c].orientation == half.orientation, "a child's orientation");
            const Nodes of_child = known_.nodes(children[c]);
            for (std::size_t k = 0; k < corners_; ++k) {
                demand(of_child[k] == (half.corner[k] == 4 ? z : n[half.corner[k]]),
                       "a child's node");
            }
            const bool whole = is_whole(of_child) && !is_masked(children[c]);
            demand(whole || !is_whole(n), "what is whole");
        }
    }

    /// Demands that a pack of questions gets the answers of single ones: middles of nodes and of
    /// keys, and positions.
    void check_packs(Node a, Node b, Node z) {
        demand(halves_packs(
                   a, b, z,
                   [&](const auto& from, const auto& to) -> decltype(known_.middle(from, to)) {
                       return known_.middle(from, to);
                   }),
               "the middle of a pack of nodes");
        if constexpr (PacksPositions<Known>) {
            std::array<Node, doubles_at_once> nodes;
            for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = i % 2 == 0 ? a : z;
            known_.template with_packed_positions<doubles_at_once>([&](const auto& positions) {
                const auto x = positions(Pack<Node, doubles_at_once>::load(nodes.data()));
                for (std::size_t i = 0; i < nodes.size(); ++i) {
                    const Point one{x[0].numbers()[i], x[1].numbers()[i], x[2].numbers()[i]};
                    demand(one == known_.position(nodes[i]), "the position of a pack of nodes");
                }
            });
        }
        if constexpr (KnowsPatches<Known>) {
            const NodeKey key = known_.key(z);
            demand(known_.middle_key(known_.key(a), known_.key(b)) == key, "the key between two");
            demand(halves_packs(known_.key(a), known_.key(b), key,
                                [&](const auto& from,
                                    const auto& to) -> decltype(known_.middle_key(from, to)) {
                                    return known_.middle_key(from, to);
                                }),
                   "the middle of a pack of keys");
        }
    }
    /// Whether middle(), of packs of `from` and `to`, gives `between` in all places; true where it
    /// takes no packs.
    template <class T, class Middle>
    static bool halves_packs(T from, T to, T between, const Middle& middle) {
        if constexpr (Packable<T>) {
            if constexpr (std::is_invocable_v<Middle, Pack<T>, Pack<T>>) {
                const auto all = middle(Pack<T>::all(from), Pack<T>::all(to)).numbers();
                return std::ranges::count(all, between) == std::ssize(all);
            }
        }
        return true;
    }

    /// Demands that gradients in a row are those of single nodes, and those at corners.
    void check_gradients(const Element& e, const Nodes& n) const {
        if (!values_.gives_gradients()) return;
        std::array<Point, corners_> row{};
        values_.gradients_at(n, row);
        for (std::size_t k = 0; k < corners_; ++k) {
            Point one{};
            values_.gradients_at(std::span(&n[k], 1), std::span(&one, 1));
            demand(one == row[k], "a gradient in a row");
        }
        if (!offers_gradients<Grid>(field_)) return;
        std::array<Point, corners_> own{};
        detail::call_corner_gradients(field_, context_, e, std::span<Point>(own));
        demand(own == row, "the gradient at a corner");
    }

    /// Demands that a row of questions gets the answers of single ones.
    /// \param n corners of an element
    /// \param a, b ends of the edge at which its bisection splits it
    void check_rows(const Nodes& n, Node a, Node b) const {
        std::array<NodeKey, corners_> keys;
        std::array<Point, corners_> x;
        std::array<Real, corners_> u;
        known_.keys(n, keys);
        for (std::size_t i = 0; i < n.size(); ++i) {
            demand(keys[i] == known_.key(n[i]), "a key in a row");
        }
        known_.positions(n, x);
        values_.values_at(n, keys, u);  // the keys passed the loop above
        for (std::size_t i = 0; i < n.size(); ++i) {
            demand(x[i] == known_.position(n[i]), "a position in a row");
            demand(u[i] == values_.template value_at<true>(n[i], keys[i]), "a value in a row");
        }
        // The edge in both directions; the answers overwrite the first argument.
        std::array<Node, 3> between{a, b, a};
        const std::array<Node, 3> to{b, a, b};
        known_.perhaps_middles(between, to, between);
        const Node z = known_.halved(a, b) ? known_.middle(a, b) : Known::no_node;
        demand(std::ranges::count(between, z) == std::ssize(between), "a middle in a row");
    }

    /// Number of elements `height` levels below e. Adds to `split` how many of these are split.
    std::size_t count_patch_ends(const Element& e, std::size_t height, std::size_t& split) {
        const Rule* rule = detail::call_split(grid_, context_, e);
        if (height == 0) {
            split += rule != nullptr ? 1U : 0U;
            return 1;
        }
        if (rule == nullptr) return 0;
        std::array<Element, 2> children;
        detail::call_children(grid_, context_, e, std::span<Element>(children));
        std::size_t count = 0;
        for (const Element& child : children) count += count_patch_ends(child, height - 1, split);
        return count;
    }

    bool is_whole(const Nodes& nodes) const {
        if constexpr (requires { known_.whole(nodes); }) {
            if (known_.whole(nodes)) return true;
        }
        return known_.whole();
    }
    bool is_masked(const Element& e) {
        if constexpr (may_offer<Grid>(Feature::masked)) {
            return offers(grid_, Feature::masked) && detail::call_masked(grid_, context_, e);
        }
        return false;
    }

    const Grid& grid_;
    const Field& field_;
    const Known& known_;
    const Values& values_;
    Context<Grid>& context_;
    std::string name_;  // path from the coarse grid to the element at hand
};

}  // namespace nestgrid::engine
