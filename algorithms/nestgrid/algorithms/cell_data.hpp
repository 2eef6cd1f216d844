// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Turns data in cells, which finite volume codes have, into a nodal field. The value at a node is
// the mean of the leaves around it by weights 1/size, brought to the node where it lies beside it:
// at walls, on simplices, where spacings change (detail/node_means.hpp). A linear function is
// reproduced, at changes of level and at walls too, so a plane has no crease. Nodes that hang get
// a value too, but the walk puts the interpolant in its place. Hidden leaves count for nothing:
// what borders on them is a wall. A node of hidden leaves alone gets some value between those of
// all other leaves. Nothing is drawn there.
//
// Inside, a value is in the range of the leaves around it. At walls it may leave that range, and
// that of all leaves by no more than its length: a density may fall below 0 there.
//
// Invariants: equal values give that value, to the last bit, so that plateaus stay flat; the order
// and the numbering of leaves do not matter.
// Memory: O(nodes), 40 to 72 bytes a node, and while it is built 40 more and 16 for each corner of
// each leaf. Leaves at walls, of simplices and beside nodes that hang take 300 to 400 bytes more.
// On ranks each tells its leaves to those that have a corner of them, and has the same means.
#pragma once

#include <concepts>
#include <cstdint>
#include <utility>

#include <nestgrid/algorithms/detail/for_each_leaf.hpp>
#include <nestgrid/algorithms/detail/node_means.hpp>
#include <nestgrid/detail/erase.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// How values of cells become values at nodes. Those that are sharp have second differences of the
/// cells taken off, which the means add, as far as the range of the cells around a node lets them:
/// on cubes of one size, quadratic functions are reproduced inside.
enum class CellRule : std::uint8_t {
    smooth,         ///< the means, which lie within the range of the cells
    sharp_centres,  ///< of values at the centres of cells
    sharp_means,    ///< of means of cells, as finite volumes have
};

/// \tparam Grid with node keys of its own
/// \tparam LeafValue callable as a number of LeafValue(const Element&) for every leaf
template <class Grid, class LeafValue>
class CellAverages {
    static_assert(require_nested_grid<Grid>());
    static_assert(may_offer<Grid>(Feature::own_keys),
                  "CellAverages needs a grid with node keys of its own: 'corner_keys' and "
                  "'new_keys'.");

public:
    using value_type = double;
    using Element = ElementOf<Grid>;

    /// Walks the whole hierarchy twice, or five times where the rule is sharp, and asks each leaf
    /// as often, for the same number; three and eight times on ranks. The grid must outlive the
    /// field and stay as it is. Collective, where the grid is a Distributed (distributed.hpp).
    /// \throw InvalidInput where the grid has no node keys of its own
    CellAverages(const Grid& grid, LeafValue of_leaf, CellRule rule = CellRule::smooth);

    /// The value of the cell itself; only leaves have one.
    double leaf_value(const Element& leaf) const { return static_cast<double>(leaf_value_(leaf)); }

    /// \throw GridError where the grid has changed since the means were computed
    NodeMask coarse_values(std::size_t i, std::span<double> out, Context<Grid>& context) const {
        if (epoch(*grid_) != epoch_) {
            throw GridError("the grid has changed since the means of its cells were computed");
        }
        const auto coarse = detail::call_coarse(*grid_, context, i);
        std::array<NodeKey, max_corners> keys;
        const std::size_t count = topology(coarse.shape).corners;
        detail::call_corner_keys(*grid_, context, coarse.element,
                                 std::span<NodeKey>(keys.data(), count));
        return look_up(std::span<const NodeKey>(keys.data(), count), ~NodeMask{0}, out);
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<double> out,
                        Context<Grid>& context) const {
        std::array<NodeKey, max_new_nodes> keys;
        const auto count =
            static_cast<std::size_t>(detail::call_split(*grid_, context, e)->new_node_count());
        detail::call_new_keys(*grid_, context, e, std::span<NodeKey>(keys.data(), count));
        return look_up(std::span<const NodeKey>(keys.data(), count), which, out);
    }

    std::size_t memory_bytes() const { return means_.memory_bytes(); }

private:
    detail::NodeMeans make_means(CellRule rule) const {
        const auto hierarchy = erase(*grid_, ZeroField<Grid>{});
        const detail::ForEachCell for_each_cell = [&](const auto& visit) {
            detail::for_each_leaf(hierarchy, [&](const detail::LeafView& leaf) {
                visit({leaf.shape, leaf.keys, leaf.positions,
                       leaf_value(detail::element_of<Element>(leaf.element))});
            });
        };
        detail::NodeMeans means(Grid::dimension, for_each_cell, hierarchy.facts().shared);
        if (rule == CellRule::smooth) return means;
        const double part = rule == CellRule::sharp_centres ? 1.0 / 2 : 2.0 / 3;
        means.sharpen(Grid::dimension, for_each_cell, part);
        return means;
    }
    NodeMask look_up(std::span<const NodeKey> keys, NodeMask which, std::span<double> out) const {
        NodeMask missing = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if ((which >> i & 1U) == 0) continue;
            if (const double* mean = means_.find(keys[i])) {
                out[i] = *mean;
            } else if (may_offer<Grid>(Feature::hidden) && offers(*grid_, Feature::hidden)) {
                out[i] = means_.middle();
            } else {
                missing |= NodeMask{1} << i;
            }
        }
        return missing;
    }

    const Grid* grid_;
    LeafValue leaf_value_;
    std::uint64_t epoch_;
    detail::NodeMeans means_;
};

template <class Grid, class LeafValue>
CellAverages<Grid, LeafValue>::CellAverages(const Grid& grid, LeafValue of_leaf, CellRule rule)
    : grid_{&grid}, leaf_value_{std::move(of_leaf)}, epoch_{epoch(grid)} {
    if (!offers(grid, Feature::own_keys)) {
        throw InvalidInput("the means of cells need a grid with node keys of its own");
    }
    means_ = make_means(rule);
}

}  // namespace nestgrid
