// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections known at compile time, of elements that are nothing but their corners. They let the
// traversal keep an element in registers.
//
// A grid may offer, beside its required operations:
//     using Node                                    a small value that identifies a node
//     static constexpr std::array<KnownBisection, k> bisections;
//     std::size_t bisection(e)                      number in `bisections` of the one that splits
//                                                   e, or would split the leaf e
//     std::array<Node, dimension + 1> nodes(e)      the corners of e
//     Element element(std::size_t number, const std::array<Node, dimension + 1>& nodes)
//                                                   the element with these corners that bisection
//                                                   `number` splits
//     const Rule& rule(std::size_t number)          bisection `number` as a rule
//     bool halved(Node a, Node b)                   whether the grid splits the elements whose
//                                                   bisection would halve the edge from a to b
//     Node middle(Node a, Node b)                   the new node on that edge; where nodes are
//                                                   numbers, preferably of Packs of nodes, too
//     NodeKey key(Node)
//     Point position(Node)
//     bool whole()                                  whether nothing is masked or outside
// and, preferably,
//     void with_packed_positions<count>(function)   calls function(positions), once, where
//                                                   positions(Pack<Node, count>) is a
//                                                   PackedPoint<count> of the same positions
// They must agree with split(), children(), new_keys(), corner_keys() and corner_positions(). The
// grid must have no hanging nodes, and must offer own keys, own positions and boundary faces. Its
// field offers
//     template <bool whole> value_type value_at(Node, NodeKey)
//                                                   the value at a node; `whole` is true only
//                                                   where whole() is
//     Point gradient_at(Node)                       optional: the gradient of the data at a node
// or, where values at new nodes are means of those at their parents,
//     value_type mean(value_type a, value_type b)   of Packs of values, too (mean_values.hpp)
//
// The grid may also offer patches (bisection_patch.hpp), which the engine walks side by side
// (patch_walk.hpp):
//     static constexpr std::size_t patch_height     2 or 3
//     NodeKey middle_key(NodeKey a, NodeKey b)      key of the new node between nodes with keys a
//                                                   and b; preferably of Packs of keys, too
//     bool whole(const std::array<Node, dimension + 1>& nodes)
//                                                   where whole() may be false: whether the
//                                                   element with these corners is whole, that is,
//                                                   neither it nor anything in it is masked or
//                                                   outside
// By this it promises: an element that the last one of `bisections` splits is split patch_height
// times over, into elements of the last bisection again, and the grid splits all of these or none.
// Where each question is a call, as through a table, the grid answers rows of questions instead of
// middle_key(), and the field, too:
//     void middles(span<const Node> a, span<const Node> b, span<Node> out)
//     void keys(span<const Node>, span<NodeKey> out)
//     void positions(span<const Node>, span<Point> out)
//     static constexpr Node no_node
//     void perhaps_middles(span<const Node> a, span<const Node> b, span<Node> out)
//                                                   no_node where the grid does not halve an edge
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

namespace nestgrid::engine {

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

/// A grid that tells which of its elements are whole.
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

}  // namespace nestgrid::engine
