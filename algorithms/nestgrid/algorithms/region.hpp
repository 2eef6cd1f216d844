// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fine inside a region, coarse outside (the lens of the paper, section 4.2).
//
// Two thresholds on one indicator would crack: which of them holds at a node would depend on the
// node alone, and a node outside may have finer nodes inside. So a node belongs to the region if it
// or any node created, at any depth, in elements it is a corner of, lies there: a saturated
// indicator with the values 0 and 1. Then
//     S = S_out and (S_in or not in the region)
// is saturated, for where both (one) of two saturated criteria hold(s) at a corner, the same hold
// at the new nodes.
// Memory: a byte a node (a key a node where keys are not dense); while it is made without stars, 4
// bytes for each node of each split. Cost: one pass over the stars, where the grid offers them,
// else one walk and a few sweeps over its splits.
#pragma once

#include <algorithm>
#include <utility>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/node_numbers.hpp>
#include <nestgrid/algorithms/splits_by_level.hpp>
#include <nestgrid/derive_hanging.hpp>
#include <nestgrid/key_table.hpp>
#include <nestgrid/levels.hpp>

namespace nestgrid {

class Region {
public:
    static constexpr bool saturated = true;

    /// An empty region.
    Region() = default;
    /// \param inside whether a point lies in the region: bool(const Point&)
    template <class Grid, class Inside>
    Region(const Grid& grid, Inside&& inside) : dense_(dense_key_count(grid), 0) {
        if constexpr (requires {
                          grid.for_each_star_row([](const StarRow&) {});
                          grid.node_position(NodeKey{});
                      }) {
            sweep_stars(grid, inside);
        } else {
            sweep_levels(grid, inside);
        }
    }

    bool contains(NodeKey node) const {
        return dense_.empty() ? sparse_.find(node) != nullptr
                              : dense_[static_cast<std::size_t>(node)] != 0;
    }

    /// As an indicator: 1 in the region, 0 outside.
    double stop(NodeKey node) const { return contains(node) ? 1 : 0; }

private:
    struct Present {};

    template <class Grid, class Inside>
    void sweep_stars(const Grid& grid, Inside&& inside) {
        constexpr std::uint8_t gathered = 2;  // of nodes that stand for others
        grid.for_each_star_row([&](const StarRow& row) {
            for (std::size_t i = 0; i < row.count; ++i) {
                const std::size_t node = row.first + i * row.stride;
                std::uint8_t finer = 0;
                for (const std::ptrdiff_t offset : row.finer) {
                    finer |= dense_[node + static_cast<std::size_t>(offset)];
                }
                if (row.gathers) {
                    if (finer != 0) dense_[node] |= gathered;
                } else {
                    const bool is_inside = inside(grid.node_position(static_cast<NodeKey>(node)));
                    dense_[node] = is_inside || finer != 0 ? 1 : 0;
                }
            }
        });
        for (std::uint8_t& mark : dense_) mark &= 1U;
    }

    template <class Grid, class Inside>
    void sweep_levels(const Grid& grid, Inside&& inside) {
        const ZeroField<Grid> zero;
        using Walk = Traversal<Grid, ZeroField<Grid>, Needs{.keys = true, .positions = true}>;
        const Walk walk(grid, zero);
        NodeNumbers numbers(dense_.size());
        std::vector<std::uint8_t> marks(numbers.count(), 0);  // by number
        SplitsByLevel splits(marks.size());
        std::array<NodeKey, max_corners> keys;
        std::array<Point, max_corners> x;
        std::array<std::size_t, max_corners + max_new_nodes> nodes;
        for_each_element(walk, [&](const auto& s, const Split& split) {
            const auto corners = static_cast<std::size_t>(s.corner_count());
            walk.keys(s, keys);
            walk.positions(s, x);
            numbers.find(std::span(keys).first(corners), nodes);
            numbers.find(split.keys, std::span(nodes).subspan(corners));
            marks.resize(numbers.count());
            for (std::size_t i = 0; i < corners; ++i) {
                if (inside(x[i])) marks[nodes[i]] = 1;
            }
            if (split.rule == nullptr) return;
            splits.add(static_cast<std::size_t>(s.level), *split.rule,
                       std::span(nodes).first(corners + split.keys.size()));
        });
        bool changed = true;
        const auto mark = [&](std::size_t node) {
            changed = std::exchange(marks[node], std::uint8_t{1}) == 0 || changed;
        };
        const auto spread = [&](const Rule& rule, std::span<const std::size_t> of) {
            const auto corners = static_cast<std::size_t>(rule.corner_count());
            bool below = false;
            for (std::size_t n = of.size(); n-- > corners;) {
                if (marks[of[n]] == 0) continue;
                below = true;
                // A parent that is a new node itself is to this one as a corner is.
                const Stencil& stencil = rule.new_nodes[n - corners];
                for (std::size_t i = 0; i < stencil.count; ++i) {
                    if (stencil.parent[i] >= corners) mark(of[stencil.parent[i]]);
                }
            }
            if (below) std::ranges::for_each(of.first(corners), mark);
        };
        while (std::exchange(changed, false)) {
            for (std::size_t level = splits.levels(); level-- > 0;) splits.for_each(level, spread);
        }
        if (!dense_.empty()) {
            dense_ = std::move(marks);
        } else {
            numbers.for_each([&](NodeKey key, std::size_t of) {
                if (marks[of] != 0) sparse_.insert(key, {});
            });
        }
    }

    std::vector<std::uint8_t> dense_;
    KeyTable<NodeKey, Present> sparse_;
};

/// S for a threshold outside a region and a smaller one inside; both must outlive the criterion.
template <class Indicator>
auto fine_inside(const Region& region, const Indicator& indicator, double outside, double inside) {
    return Threshold<Indicator>{&indicator, outside} &&
           (Threshold<Indicator>{&indicator, inside} || Threshold<Region>{&region, 0.5});
}

}  // namespace nestgrid
