// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll of any hierarchy: one walk, and sweeps over its splits, fine to coarse, since "a
// depth first traversal of the hierarchy in the adjustment procedure would not be sufficient"
// (paper, section 2). Included by indicator.hpp.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/node_numbers.hpp>
#include <nestgrid/algorithms/splits_by_level.hpp>

namespace nestgrid {

namespace detail {

/// A field on its way through a walk whose visitor has fetched the values at new nodes itself.
template <class Grid, class Field>
struct FetchedField {
    using value_type = typename Field::value_type;
    static constexpr int components = components_of<Field>();

    const Field* field;
    const value_type* fetched;  ///< for the element inspected last

    NodeMask coarse_values(std::size_t i, std::span<value_type> out, Context<Grid>& context) const {
        return call_coarse_values(*field, context, i, out);
    }
    NodeMask new_values(const ElementOf<Grid>&, NodeMask, std::span<value_type> out) const {
        std::copy_n(fetched, out.size(), out.begin());
        return 0;
    }
};

}  // namespace detail

template <class Grid, class Field, class LeafError>
void HierarchicalIndicator::sweep_levels(const Grid& grid, const Field& field,
                                         [[maybe_unused]] const LeafError& leaf_error) {
    constexpr bool of_leaves = !std::is_same_v<LeafError, detail::Nothing>;
    using Real = typename Field::value_type;
    constexpr double limit = std::numeric_limits<Real>::max() / 8;
    constexpr auto stride = static_cast<std::size_t>(detail::components_of<Field>());
    std::array<Real, max_new_nodes * stride> given;
    using Fetched = detail::FetchedField<Grid, Field>;
    const Fetched fetched{&field, given.data()};
    const Traversal<Grid, Fetched, Needs{.keys = true}> walk(grid, fetched, hanging());
    NodeNumbers number_of(dense_key_count(grid));
    std::vector<Node> nodes(number_of.count());
    std::vector<std::uint8_t> made_on(nodes.size(), 0);  // 1 + level, modulo 255; 0: not known yet
    SplitsByLevel splits(nodes.size());
    bool one_sweep = true;
    bool all_divided = true;
    finest_level_ = 0;
    std::array<NodeKey, max_corners> corner_keys;
    std::array<std::size_t, max_corners + max_new_nodes> numbers;

    // Offsets, from the true values.
    for_each_element<!of_leaves>(walk, [&](const auto& s, const Split& split) {
        const auto corners = static_cast<std::size_t>(s.corner_count());
        walk.keys(s, corner_keys);
        number_of.find(std::span(corner_keys).first(corners), numbers);
        number_of.find(split.keys, std::span(numbers).subspan(corners));
        nodes.resize(number_of.count());
        made_on.resize(number_of.count());
        if (s.level == 0) {
            for (std::size_t i = 0; i < corners; ++i) add_value(s.value[i * stride], limit);
        }
        if (split.rule == nullptr) {
            if constexpr (of_leaves) {
                const double error = leaf_error(s.element);
                if (!(error >= 0)) {
                    throw InvalidInput("the error of a leaf is not a usable number: " +
                                       std::to_string(error));
                }
                for (std::size_t i = 0; i < corners; ++i) {
                    std::uint16_t& stop = nodes[numbers[i]].entry.stop;
                    stop = std::max(stop, bfloat16_above(float_above(error)));
                }
            }
            return;
        }
        const Rule& rule = *split.rule;
        largest_split_ = std::max(largest_split_, rule.new_nodes.size());
        one_sweep = one_sweep && rule.steps == 1;
        all_divided = all_divided && rule.divides_all;
        finest_level_ = std::max(finest_level_, s.level + 1);
        std::array<Real, max_corners + max_new_nodes> value;
        for (std::size_t i = 0; i < corners; ++i) value[i] = s.value[i * stride];
        const NodeMask which = rule.all() & ~split.constrained;
        const NodeMask missing =
            detail::call_new_values(field, *s.context, s.element, rule.all(),
                                    std::span<Real>(given.data(), rule.new_nodes.size() * stride));
        detail::require_no_missing(missing & which, s);
        const auto level = static_cast<std::uint8_t>(1 + s.level % 255);
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const Stencil& stencil = rule.new_nodes[n];
            const std::size_t at = numbers[corners + n];
            Node& node = nodes[at];
            const bool is_new = made_on[at] == 0;
            one_sweep = one_sweep && (is_new || made_on[at] == level);
            made_on[at] = level;
            if ((which >> n & 1U) == 0) {
                value[corners + n] = detail::interpolate(stencil, value.data(), 1);
                if ((missing >> n & 1U) == 0) {
                    const double off = std::abs(static_cast<double>(given[n * stride]) -
                                                static_cast<double>(value[corners + n]));
                    if (!(off <= hanging_violation_)) hanging_violation_ = off;
                }
            } else {
                value[corners + n] = given[n * stride];
                add_value(given[n * stride], limit);
                if (is_new) {  // every element that makes it has the same parents for it
                    node.offset = detail::offset_above(
                        value[corners + n], detail::interpolate(stencil, value.data(), 1));
                }
            }
            const std::uint16_t own = (split.outside >> n & 1U) != 0 ? bfloat16_infinity
                                      : of_leaves                    ? std::uint16_t{0}
                                                                     : bfloat16_above(node.offset);
            node.entry.stop = std::max(node.entry.stop, own);
        }
        splits.add(static_cast<std::size_t>(s.level), rule,
                   std::span<const std::size_t>(numbers).first(corners + rule.new_nodes.size()));
    });

    if (!all_divided) finest_level_ = -1;

    // Saturation and bounds: fine to coarse until nothing changes, since a node may be created on
    // different levels of the tree. Where none is, one sweep does it.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t level = splits.levels(); level-- > 0;) {
            splits.for_each(level, [&](const Rule& rule, std::span<const std::size_t> of) {
                const auto raise = [&](std::size_t at, std::uint16_t stop, float bound) {
                    Node& node = nodes[at];
                    if (node.entry.stop < stop || node.finer < bound) changed = true;
                    node.entry.stop = std::max(node.entry.stop, stop);
                    node.finer = std::max(node.finer, bound);
                };
                const auto corners = static_cast<std::size_t>(rule.corner_count());
                const std::span<const std::size_t> made = of.subspan(corners);
                std::uint16_t stop = 0;
                float bound = 0;
                for (std::size_t n = made.size(); n-- > 0;) {
                    const Node node = nodes[made[n]];
                    const float below = sum_above(node.offset, node.finer);
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
                    Entry& within = nodes[made[rule.inside]].entry;
                    within.stop = std::max(within.stop, stop);
                    within.bound = std::max(within.bound, bfloat16_above(bound));
                }
                for (const std::size_t corner : of.first(corners)) raise(corner, stop, bound);
            });
        }
        changed = changed && !one_sweep;
    }

    for (Node& node : nodes) {
        node.entry.bound =
            std::max(node.entry.bound, bfloat16_above(sum_above(node.offset, node.finer)));
    }
    node_count_ = nodes.size();
    if (number_of.are_keys()) {
        dense_ = std::make_unique<Entry[]>(nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) dense_[i] = nodes[i].entry;
    } else {
        sparse_.reserve(nodes.size());
        number_of.for_each(
            [&](NodeKey key, std::size_t at) { sparse_.insert(key, nodes[at].entry); });
    }
}

}  // namespace nestgrid
