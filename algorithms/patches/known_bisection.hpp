// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections known at compile time, of elements that are nothing but their corners: what lets the
// traversal keep an element in registers.
//
// A grid may offer, beside what it must:
//     using Node                                       a handle of a node, a small value
//     static constexpr std::array<KnownBisection, k> bisections;
//     std::size_t bisection(e)                         which one splits e, where it is split
//     std::array<Node, dimension + 1> nodes(e)
//     Element element(std::size_t number, const std::array<Node, dimension + 1>&)
//     const Rule& rule(std::size_t number)
//     bool halved(Node a, Node b)                      whether an edge to be bisected is
//     Node middle(Node a, Node b)                      its new node; where nodes are numbers, best
//                                                      of a Pack of them as well
//     NodeKey key(Node)
//     Point position(Node)
//     bool whole()                                     that nothing is masked or outside
// and, best,
//     void with_packed_positions<count>(function)      calls function(positions), once, where
//                                                      positions(Pack<Node, count>) is a
//                                                      PackedPoint<count> of the same positions
// They must agree with split(), children(), new_keys(), corner_keys() and corner_positions(); its
// field offers
//     template <bool whole> value_type value_at(Node, NodeKey)
// Nothing hangs in such a grid, and it knows keys, positions and boundary faces by heart. It may
// also offer
//     static constexpr std::size_t patch_height        2 or 3
//     NodeKey middle_key(NodeKey a, NodeKey b)         key of the new node between two; likewise
//     bool whole(const std::array<Node, dimension + 1>& nodes)
//                                                      of a grid that is not whole(): that nothing
//                                                      in the element with these nodes is masked or
//                                                      outside, nor a node of it
// which says that an element split by the last of the bisections is split that many times over,
// into elements of the last bisection again, of which either all are split or none; then those are
// looked at together (patch_walk.hpp), where they are whole. Where each question is a call, as
// through a table, it offers answers in rows instead of middle_key(), and its field values:
//     void middles(span<const Node> a, span<const Node> b, span<Node> out)
//     void keys(span<const Node>, span<NodeKey> out)
//     void positions(span<const Node>, span<Point> out)
//     static constexpr Node no_node
//     void perhaps_middles(span<const Node> a, span<const Node> b, span<Node> out)
//                                                      no_node where an edge is not halved
//     void values_at(span<const Node>, span<const NodeKey>, span<value_type> out)
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <span>

#include <nestgrid/detail/known_bisection.hpp>
#include <nestgrid/detail/operations.hpp>
#include <nestgrid/detail/pack.hpp>
#include <walk/visit.hpp>

namespace nestgrid {

template <class Grid, class Field>
concept KnowsBisections = requires(const Grid& grid, const Field& field, const ElementOf<Grid>& e,
                                   typename Grid::Node node) {
    { Grid::bisections.size() } -> std::convertible_to<std::size_t>;
    { grid.bisection(e) } -> std::convertible_to<std::size_t>;
    { grid.element(std::size_t{}, grid.nodes(e)) } -> std::same_as<ElementOf<Grid>>;
    { grid.rule(std::size_t{}) } -> std::same_as<const Rule&>;
    { grid.halved(node, node) } -> std::same_as<bool>;
    { grid.middle(node, node) } -> std::same_as<typename Grid::Node>;
    { grid.key(node) } -> std::same_as<NodeKey>;
    { grid.position(node) } -> std::same_as<Point>;
    { grid.whole() } -> std::same_as<bool>;
    { field.template value_at<true>(node, NodeKey{}) } -> std::same_as<typename Field::value_type>;
};

template <class Grid>
concept PacksPositions = Packable<typename Grid::Node> && requires(const Grid& grid) {
    grid.template with_packed_positions<doubles_at_once>([](auto&&) {});
};

template <class Grid>
concept AnswersInRows = requires(const Grid& grid, std::span<const typename Grid::Node> nodes,
                                 std::span<typename Grid::Node> middles, std::span<NodeKey> keys,
                                 std::span<Point> x) {
    grid.middles(nodes, nodes, middles);
    grid.keys(nodes, keys);
    grid.positions(nodes, x);
    grid.perhaps_middles(nodes, nodes, middles);
    { Grid::no_node } -> std::convertible_to<typename Grid::Node>;
};

/// Of a grid that is not whole.
template <class Grid>
concept TellsWhereWhole = requires(
    const Grid& grid,
    const std::array<typename Grid::Node, static_cast<std::size_t>(Grid::dimension) + 1>& nodes) {
    { grid.whole(nodes) } -> std::same_as<bool>;
};

template <class Grid>
concept KnowsPatches = requires(const Grid& grid) {
    requires Grid::patch_height == 2 || Grid::patch_height == 3;
    requires AnswersInRows<Grid> || requires {
        { grid.middle_key(NodeKey{}, NodeKey{}) } -> std::same_as<NodeKey>;
    };
};

}  // namespace nestgrid
