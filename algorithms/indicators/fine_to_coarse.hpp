// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The sweep that saturates a function of nodes (paper, section 2):
//     eta*(x) = max( eta(x), factor * (eta*(y) + slope * |x - y|) )
// over all nodes y made in elements with the corner x. Factor 1 and slope 0 make S = (eta* <=
// epsilon) saturated; a slope does so for thresholds that vary in space with at most that slope, a
// factor for weights between epsilon and factor * epsilon. |x - y| is rounded up to the greatest
// distance between a corner and a new node of the split. A parent of y that is a new node of the
// same split counts as a corner x, too.
//
// A child that is split again has a new node of its father for a corner (find_violation() of rules
// sees to it), so that the sweep reaches a node from all finer ones through one split at a time.
// It goes fine to coarse until nothing changes, because a node may be created on several levels.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <indicators/node_numbers.hpp>
#include <indicators/splits_by_level.hpp>
#include <nestgrid/algorithms/detail/node_table.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

/// Raises the corners of one split, and those of its new nodes that are parents of others, to the
/// numbers that its new nodes hand on.
/// \param of the corners and, behind them, the new nodes, by number
/// \param of_node of_node(node) is the number of a new node
/// \param hand hand(number), monotone, is what a new node with that number hands to its parents
/// \param raise raise(node, number) raises a node to a number and returns whether that changed it
/// \param greatest set to the maximum of itself and the numbers of the new nodes
/// \return whether any node was raised
template <class Number, class OfNode, class Hand, class Raise>
bool raise_parents(const Rule& rule, std::span<const std::size_t> of, const OfNode& of_node,
                   const Hand& hand, const Raise& raise, Number& greatest) {
    using std::max;
    bool changed = false;
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    const std::span<const std::size_t> made = of.subspan(corners);
    for (std::size_t n = made.size(); n-- > 0;) {
        const Number number = of_node(made[n]);
        greatest = max(greatest, number);
        if (rule.steps == 1) continue;
        const Stencil& stencil = rule.new_nodes[n];
        for (std::size_t i = 0; i < stencil.count; ++i) {
            if (stencil.parent[i] < corners) continue;
            changed |= raise(of[stencil.parent[i]], hand(number));
        }
    }
    const Number handed = hand(greatest);
    for (const std::size_t corner : of.first(corners)) changed |= raise(corner, handed);
    return changed;
}

/// Calls sweep_split(rule, numbers, reach) for all splits, fine to coarse, until it changes
/// nothing.
/// \param once whether one round is enough
template <class SweepSplit>
void sweep(const SplitsByLevel& splits, bool once, const SweepSplit& sweep_split) {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t level = splits.levels(); level-- > 0;) {
            splits.for_each(level, [&](const Rule& rule, std::span<const std::size_t> of,
                                       float reach) { changed |= sweep_split(rule, of, reach); });
        }
        changed = changed && !once;
    }
}

/// One number per node of a hierarchy, and all splits, over which saturate() takes maxima.
/// \tparam Number is ordered by <; where nodes are shared, an integer of 16 bits or fewer
template <class Number>
class NodeMaxima {
public:
    /// \param dense how many dense keys there are, or 0
    /// \param least the number of nodes for which none was set
    NodeMaxima(std::size_t dense, Number least)
        : numbers_{dense},
          values_(numbers_.count(), least),
          splits_{values_.size()},
          least_{least} {}

    /// Finds the numbers of nodes by their keys.
    void find(std::span<const NodeKey> keys, std::span<std::size_t> out) {
        numbers_.find(keys, out);
        values_.resize(numbers_.count(), least_);
    }
    /// The number of one node.
    std::size_t number(NodeKey key) {
        std::size_t node = 0;
        find(std::span(&key, 1), std::span(&node, 1));
        return node;
    }
    Number& operator[](std::size_t node) { return values_[node]; }
    /// \param nodes numbers of the corners and, behind them, of the new nodes
    /// \param reach the greatest distance between a corner and a new node, where distances count
    void add_split(int level, const Rule& rule, std::span<const std::size_t> nodes,
                   float reach = 0) {
        splits_.add(static_cast<std::size_t>(level), rule, nodes, reach);
    }

    /// Collective where nodes are shared.
    /// \param shared the nodes that other ranks have, too, or null
    void saturate(const SharedNodes* shared = nullptr) {
        saturate([](const Number& number, float) { return number; }, shared);
    }
    /// \param hand hand(number, reach), monotone, is what a new node with that number hands to its
    ///        parents
    template <class Hand>
    void saturate(const Hand& hand, const SharedNodes* shared = nullptr) {
        sweep_all(hand);
        while (shared != nullptr && raise_across(*shared)) sweep_all(hand);
    }

    /// Raises shared nodes to the greatest numbers that any rank has for them. Collective.
    /// \return whether some rank was told more than it knew
    bool raise_across(const SharedNodes& shared) {
        using Told = std::array<std::uint16_t, 1>;
        return shared.raise<Told>([&](NodeKey key) { return Told{to_wire(at(key))}; },
                                  [&](NodeKey key, const Told& told) {
                                      Number& number = at(key);
                                      const bool raises = to_wire(number) < told[0];
                                      if (raises) number = from_wire(told[0]);
                                      return raises;
                                  });
    }
    /// Lowers shared nodes to the least numbers that were set on any rank. Collective.
    void lower_across(const SharedNodes& shared) {
        using Told = std::array<std::uint16_t, 1>;
        const auto turned = [&](Number number) {
            return number == least_ ? std::uint16_t{0}
                                    : static_cast<std::uint16_t>(~to_wire(number));
        };
        shared.raise<Told>([&](NodeKey key) { return Told{turned(at(key))}; },
                           [&](NodeKey key, const Told& told) {
                               Number& number = at(key);
                               const bool lowers = turned(number) < told[0];
                               if (lowers) number = from_wire(static_cast<std::uint16_t>(~told[0]));
                               return lowers;
                           });
    }

    const SplitsByLevel& splits() const { return splits_; }
    /// Moves the numbers out: by key where keys are dense, else in the order of for_each().
    std::vector<Number> take() { return std::move(values_); }
    /// Moves the numbers out, by key.
    detail::NodeTable<Number> take_table() {
        detail::NodeTable<Number> table;
        if (numbers_.are_keys()) {
            table.dense = take();
            return table;
        }
        table.sparse.reserve(values_.size());
        for_each([&](NodeKey key, std::size_t node) { table.sparse.insert(key, values_[node]); });
        return table;
    }
    /// Calls function(key, number of the node), where keys are not dense.
    template <class Function>
    void for_each(Function&& function) const {
        numbers_.for_each(function);
    }

private:
    template <class Hand>
    void sweep_all(const Hand& hand) {
        const auto of_node = [&](std::size_t node) { return values_[node]; };
        const auto raise = [&](std::size_t node, const Number& to) {
            const bool raises = values_[node] < to;
            if (raises) values_[node] = to;
            return raises;
        };
        sweep(splits_, false, [&](const Rule& rule, std::span<const std::size_t> of, float reach) {
            const auto hand_here = [&](const Number& number) { return hand(number, reach); };
            Number greatest = least_;
            return raise_parents(rule, of, of_node, hand_here, raise, greatest);
        });
    }

    Number& at(NodeKey key) { return values_[number(key)]; }
    // A number with its order, without a sign.
    static constexpr std::uint16_t sign_ = std::is_signed_v<Number> ? 0x8000U : 0U;
    static std::uint16_t to_wire(Number number) {
        return static_cast<std::uint16_t>(static_cast<std::uint16_t>(number) ^ sign_);
    }
    static Number from_wire(std::uint16_t bits) { return static_cast<Number>(bits ^ sign_); }

    NodeNumbers numbers_;
    std::vector<Number> values_;
    SplitsByLevel splits_;
    Number least_;
};

}  // namespace nestgrid::engine
