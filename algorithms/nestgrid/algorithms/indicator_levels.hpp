// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll of any hierarchy: one walk (indicator_walk.hpp), and sweeps over its splits, fine to
// coarse, since "a depth first traversal of the hierarchy in the adjustment procedure would not be
// sufficient" (paper, section 2). Included by indicator.hpp.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/node_numbers.hpp>
#include <nestgrid/algorithms/splits_by_level.hpp>

namespace nestgrid {

/// All nodes and splits of a hierarchy, while their entries are computed.
class HierarchicalIndicator::Sweeps {
public:
    /// \param dense how many dense keys there are, or 0
    /// \param of_leaves whether `stop` comes from errors of leaves and not from offsets
    Sweeps(std::size_t dense, bool of_leaves)
        : number_of_{dense},
          nodes_(number_of_.count()),
          splits_{nodes_.size()},
          of_leaves_{of_leaves} {}

    template <class Offset>
    void split(const detail::MetSplit& s, Offset&& offset);
    void leaf(std::span<const NodeKey> corners, float error);

    /// To be called when all splits are known.
    void saturate();

    std::size_t node_count() const { return nodes_.size(); }
    bool numbers_are_keys() const { return number_of_.are_keys(); }
    /// Calls function(key, entry) for every node.
    template <class Function>
    void for_each(Function&& function) const;

private:
    struct Node {
        float offset = 0;  // |U_delta|, rounded up
        Entry entry{};
        std::uint16_t finer = 0;   // largest bound of finer nodes
        std::uint8_t made_on = 0;  // 1 + level, modulo 255; 0: not known yet

        std::uint16_t bound() const {
            return bfloat16_above(sum_above(offset, bfloat16_value(finer)));
        }
    };

    std::span<const std::size_t> numbers(std::span<const NodeKey> keys) {
        number_of_.find(keys, numbers_);
        nodes_.resize(number_of_.count());
        return std::span(numbers_).first(keys.size());
    }
    bool sweep(std::size_t level);

    NodeNumbers number_of_;
    std::vector<Node> nodes_;
    SplitsByLevel splits_;
    bool of_leaves_;
    bool one_sweep_ = true;  // is enough
    std::array<std::size_t, max_corners + max_new_nodes> numbers_{};
};

template <class Offset>
void HierarchicalIndicator::Sweeps::split(const detail::MetSplit& s, Offset&& offset) {
    const Rule& rule = *s.rule;
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    const std::span<const std::size_t> number = numbers(s.keys);
    one_sweep_ = one_sweep_ && rule.steps == 1;
    const auto level = static_cast<std::uint8_t>(1 + s.level % 255);
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        Node& node = nodes_[number[corners + n]];
        const bool is_new = node.made_on == 0;
        one_sweep_ = one_sweep_ && (is_new || node.made_on == level);
        node.made_on = level;
        if (is_new) node.offset = offset(n);  // every element that makes it has the same parents
        const std::uint16_t own = (s.outside >> n & 1U) != 0 ? bfloat16_infinity
                                  : of_leaves_               ? std::uint16_t{0}
                                                             : bfloat16_above(node.offset);
        node.entry.stop = std::max(node.entry.stop, own);
    }
    splits_.add(static_cast<std::size_t>(s.level), rule, number);
}

inline void HierarchicalIndicator::Sweeps::leaf(std::span<const NodeKey> corners, float error) {
    for (const std::size_t at : numbers(corners)) {
        std::uint16_t& stop = nodes_[at].entry.stop;
        stop = std::max(stop, bfloat16_above(error));
    }
}

/// Fine to coarse until nothing changes, since a node may be created on different levels of the
/// tree. Where none is, one sweep does it.
inline void HierarchicalIndicator::Sweeps::saturate() {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t level = splits_.levels(); level-- > 0;) changed |= sweep(level);
        changed = changed && !one_sweep_;
    }
    for (Node& node : nodes_) node.entry.bound = std::max(node.entry.bound, node.bound());
}

/// \return whether anything has changed
inline bool HierarchicalIndicator::Sweeps::sweep(std::size_t level) {
    bool changed = false;
    splits_.for_each(level, [&](const Rule& rule, std::span<const std::size_t> of) {
        const auto raise = [&](std::size_t at, std::uint16_t stop, std::uint16_t bound) {
            Node& node = nodes_[at];
            if (node.entry.stop < stop || node.finer < bound) changed = true;
            node.entry.stop = std::max(node.entry.stop, stop);
            node.finer = std::max(node.finer, bound);
        };
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        const std::span<const std::size_t> made = of.subspan(corners);
        std::uint16_t stop = 0;
        std::uint16_t bound = 0;
        for (std::size_t n = made.size(); n-- > 0;) {
            const Node node = nodes_[made[n]];
            const std::uint16_t below = node.bound();
            stop = std::max(stop, node.entry.stop);
            bound = std::max(bound, below);
            if (rule.steps == 1) continue;
            // A parent that is a new node itself is to this one as a corner is.
            const Stencil& stencil = rule.new_nodes[n];
            for (std::size_t i = 0; i < stencil.count; ++i) {
                if (stencil.parent[i] < corners) continue;
                raise(of[stencil.parent[i]], node.entry.stop, below);
            }
        }
        if (rule.inside != no_new_node) {
            Entry& within = nodes_[made[rule.inside]].entry;
            within.stop = std::max(within.stop, stop);
            within.bound = std::max(within.bound, bound);
        }
        for (const std::size_t corner : of.first(corners)) raise(corner, stop, bound);
    });
    return changed;
}

template <class Function>
void HierarchicalIndicator::Sweeps::for_each(Function&& function) const {
    if (!number_of_.are_keys()) {
        number_of_.for_each([&](NodeKey key, std::size_t at) { function(key, nodes_[at].entry); });
        return;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        function(static_cast<NodeKey>(i), nodes_[i].entry);
    }
}

template <class Grid, class Field, class LeafError, class E>
void HierarchicalIndicator::sweep_levels(const Grid& grid, const Field& field,
                                         const LeafError& leaf_error, const E& executor) {
    const Traversal<Grid, Field, Needs{.keys = true}> walk(grid, field, hanging());
    Sweeps sweeps(dense_key_count(grid), own_errors_);
    facts_ = detail::walk_preroll(walk, leaf_error, sweeps, executor);
    sweeps.saturate();
    node_count_ = sweeps.node_count();
    if (sweeps.numbers_are_keys()) {
        dense_ = std::make_unique_for_overwrite<Entry[]>(node_count_);
        sweeps.for_each([entries = dense_.get()](NodeKey key, const Entry& entry) {
            entries[static_cast<std::size_t>(key)] = entry;
        });
    } else {
        sparse_.reserve(node_count_);
        sweeps.for_each([&](NodeKey key, const Entry& entry) { sparse_.insert(key, entry); });
    }
}

}  // namespace nestgrid
