// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll of any hierarchy: sweeps over all splits, fine to coarse, since "a depth first
// traversal of the hierarchy in the adjustment procedure would not be sufficient" (paper,
// section 2).
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <indicators/fine_to_coarse.hpp>
#include <indicators/path_deviations.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <ranks/shared_nodes.hpp>

namespace nestgrid::engine {

/// One split as a preroll meets it.
struct PrerollSplit {
    const Rule* rule;
    int level;
    NodeMask outside;               ///< see the operation `outside`
    float reach;                    ///< between corners and new nodes at most, where it counts
    std::span<const NodeKey> keys;  ///< of the corners and the new nodes behind them
};

/// From what Sweeps computes stop and bound of nodes.
enum class MadeOf : std::uint8_t {
    offsets,      ///< both numbers
    leaf_errors,  ///< `stop`; bounds of offsets
    deviations,   ///< both numbers; bounds are not swept
};

/// All nodes and splits of a hierarchy, while their entries are computed.
class Sweeps {
public:
    /// \param dense how many dense keys there are, or 0
    /// \param spread how `stop` is handed from finer nodes to coarser ones
    Sweeps(std::size_t dense, MadeOf made_of, const Spread& spread)
        : number_of_{dense},
          nodes_(number_of_.count()),
          splits_{nodes_.size()},
          spread_{spread},
          made_of_{made_of} {}

    /// \param offset offset(n) is |U_delta| of new node n, rounded up, 0 where the node hangs
    template <class Offset>
    void split(const PrerollSplit& s, Offset&& offset);
    /// A leaf and its error, or a coarse leaf and 0.
    void leaf(std::span<const NodeKey> corners, float error);
    /// Raises the new nodes of an element to its deviation.
    void deviation(const Deviation& d);
    /// A node whose numbers are known to be at least these.
    void raise(NodeKey node, const detail::IndicatorEntry& known);

    /// Completes the entries. To be called when all splits are known. Collective where nodes are
    /// shared.
    /// \param shared the nodes that other ranks have, too, or null
    void saturate(const SharedNodes* shared = nullptr);

    /// The least, over all splits, of the greatest `stop` at new nodes of a split, after
    /// saturate(): no element stops at a lower threshold.
    std::uint16_t least_stop() const { return least_stop_; }
    std::size_t node_count() const { return nodes_.size(); }
    /// Whether each node was created on one level only.
    bool one_level_a_node() const { return one_level_; }
    /// Puts the entries of all nodes into a table or, where keys are dense, an array.
    void store(detail::IndicatorEntries& entries) const;
    /// Calls function(node, entry) for all nodes, where keys are not dense.
    template <class Function>
    void for_each(Function&& function) const {
        number_of_.for_each(
            [&](NodeKey node, std::size_t number) { function(node, nodes_[number].entry); });
    }

private:
    using Entry = detail::IndicatorEntry;

    struct Node {
        float offset = 0;  // |U_delta|, rounded up
        Entry entry{};
        std::uint16_t finer = 0;   // largest bound of finer nodes
        std::uint8_t made_on = 0;  // 1 + level, modulo 255; 0: not known yet

        /// The recursive sum.
        std::uint16_t bound() const {
            return detail::bfloat16_above(detail::sum_above(offset, detail::bfloat16_value(finer)));
        }
    };

    std::span<const std::size_t> numbers(std::span<const NodeKey> keys) {
        number_of_.find(keys, numbers_);
        nodes_.resize(number_of_.count());
        return std::span(numbers_).first(keys.size());
    }
    /// The numbers that a new node hands to its parents, which spread `stop` first.
    struct HandedOn {
        std::uint16_t stop = 0;
        std::uint16_t bound = 0;

        friend HandedOn max(const HandedOn& a, const HandedOn& b) {
            return {std::max(a.stop, b.stop), std::max(a.bound, b.bound)};
        }
    };
    void sweep_all();
    bool raise_across(const SharedNodes& shared);
    bool sweep_split(const Rule& rule, std::span<const std::size_t> of, float reach);

    NodeNumbers number_of_;
    std::vector<Node> nodes_;
    SplitsByLevel splits_;
    Spread spread_;
    MadeOf made_of_;
    std::uint16_t least_stop_ = detail::bfloat16_infinity;
    bool one_level_ = true;  // each node was created on one level
    bool one_step_ = true;   // no new node is a parent of another one of its split
    std::array<std::size_t, max_corners + max_new_nodes> numbers_{};
};

template <class Offset>
NESTGRID_INLINE void Sweeps::split(const PrerollSplit& s, Offset&& offset) {
    const Rule& rule = *s.rule;
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    const std::span<const std::size_t> number = numbers(s.keys);
    one_step_ = one_step_ && rule.steps == 1;
    const auto level = static_cast<std::uint8_t>(1 + s.level % 255);
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        Node& node = nodes_[number[corners + n]];
        const bool is_new = node.made_on == 0;
        one_level_ = one_level_ && (is_new || node.made_on == level);
        node.made_on = level;
        // Every element that makes a node has the same parents for it, but for crossing nodes, at
        // which S does not hold.
        if (is_new || (s.outside >> n & 1U) != 0) node.offset = std::max(node.offset, offset(n));
        const std::uint16_t own = (s.outside >> n & 1U) != 0 ? detail::bfloat16_infinity
                                  : made_of_ == MadeOf::leaf_errors
                                      ? std::uint16_t{0}
                                      : detail::bfloat16_above(node.offset);
        node.entry.stop = std::max(node.entry.stop, own);
    }
    splits_.add(static_cast<std::size_t>(s.level), rule, number, s.reach);
}

}  // namespace nestgrid::engine
