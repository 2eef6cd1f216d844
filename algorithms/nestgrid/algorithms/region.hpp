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
// Memory: a byte a node (a key a node where keys are not dense). Cost: one pass over the stars,
// where the grid offers them, else a few walks.
#pragma once

#include <nestgrid/algorithms/criterion.hpp>
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
        for (std::size_t i = 0; i < grid.node_count(); ++i) {
            const auto node = static_cast<NodeKey>(i);
            if (inside(grid.node_position(node))) add(node);
        }
        grid.for_each_star_row([&](const StarRow& row) {
            for (std::size_t i = 0; i < row.count; ++i) {
                const std::size_t node = row.first + i * row.stride;
                for (const std::ptrdiff_t offset : row.finer) {
                    dense_[node] |= dense_[node + static_cast<std::size_t>(offset)];
                }
            }
        });
    }

    template <class Grid, class Inside>
    void sweep_levels(const Grid& grid, Inside&& inside) {
        const ZeroField<Grid> zero;
        using Walk = Traversal<Grid, ZeroField<Grid>, Needs{.keys = true, .positions = true}>;
        const Walk walk(grid, zero);
        std::array<NodeKey, max_corners> keys;
        int levels = 0;
        for_each_element(walk, [&](const auto& s, const Split&) {
            levels = std::max(levels, s.level + 1);
            walk.keys(s, keys);
            std::array<Point, max_corners> x;
            walk.positions(s, x);
            for (std::size_t i = 0; i < static_cast<std::size_t>(s.corner_count()); ++i) {
                if (inside(x[i])) add(keys[i]);
            }
        });
        for (bool changed = true; changed;) {
            changed = false;
            for (int level = levels - 1; level >= 0; --level) {
                for_each_on_level<true>(walk, level, [&](const auto& s, const Split& split) {
                    if (split.rule == nullptr) return;
                    const auto corners = static_cast<std::size_t>(s.corner_count());
                    bool below = false;
                    for (std::size_t n = split.keys.size(); n-- > 0;) {
                        if (!contains(split.keys[n])) continue;
                        below = true;
                        // A parent that is a new node itself is to this one as a corner is.
                        const Stencil& stencil = split.rule->new_nodes[n];
                        for (std::size_t i = 0; i < stencil.count; ++i) {
                            if (stencil.parent[i] < corners) continue;
                            changed = add(split.keys[stencil.parent[i] - corners]) || changed;
                        }
                    }
                    if (!below) return;
                    walk.keys(s, keys);
                    for (std::size_t i = 0; i < corners; ++i) changed = add(keys[i]) || changed;
                });
            }
        }
    }

    /// \return whether it is new
    bool add(NodeKey node) {
        if (dense_.empty()) return sparse_.insert(node, {}).second;
        return std::exchange(dense_[static_cast<std::size_t>(node)], std::uint8_t{1}) == 0;
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
