// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Turns data in cells, which finite volume codes have, into a nodal field: the value at a node is
// the plain mean of the leaves that have it for a corner. A linear function is reproduced where
// those leaves lie symmetrically around the node. Nodes that hang get such a mean too, but the walk
// puts the interpolant in its place. Hidden leaves count for nothing; a node of hidden leaves alone
// gets the mean of all other leaves. Nothing is drawn there.
//
// Invariant: the mean of equal values is that value, to the last bit, so that plateaus stay flat.
// Memory: O(nodes), 48 to 96 bytes a node, and 64 to 128 more while it is built.
#pragma once

#include <concepts>
#include <utility>

#include <nestgrid/algorithms/detail/for_each_leaf.hpp>
#include <nestgrid/detail/erase.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

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

    /// Walks the whole hierarchy. The grid must outlive the field and stay as it is.
    /// \throw InvalidInput where the grid has no node keys of its own
    CellAverages(const Grid& grid, LeafValue of_leaf);

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
    struct Running {
        double mean = 0;
        std::uint64_t count = 0;

        void add(double value) {
            ++count;
            mean = count == 1 ? value : mean + (value - mean) / static_cast<double>(count);
        }
    };
    NodeMask look_up(std::span<const NodeKey> keys, NodeMask which, std::span<double> out) const {
        NodeMask missing = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if ((which >> i & 1U) == 0) continue;
            if (const double* mean = means_.find(keys[i])) {
                out[i] = *mean;
            } else if (offers(*grid_, Feature::hidden)) {
                out[i] = elsewhere_.mean;
            } else {
                missing |= NodeMask{1} << i;
            }
        }
        return missing;
    }

    const Grid* grid_;
    LeafValue leaf_value_;
    std::uint64_t epoch_;
    KeyTable<NodeKey, double> means_;
    Running elsewhere_;  // of all leaves that are not hidden
};

template <class Grid, class LeafValue>
CellAverages<Grid, LeafValue>::CellAverages(const Grid& grid, LeafValue of_leaf)
    : grid_{&grid}, leaf_value_{std::move(of_leaf)}, epoch_{epoch(grid)} {
    if (!offers(grid, Feature::own_keys)) {
        throw InvalidInput("the means of cells need a grid with node keys of its own");
    }
    KeyTable<NodeKey, Running> running;
    detail::for_each_leaf(erase(grid, ZeroField<Grid>{}),
                          [&](const Handle& leaf, std::span<const NodeKey> keys) {
                              const double value = leaf_value(detail::element_of<Element>(leaf));
                              elsewhere_.add(value);
                              for (const NodeKey key : keys)
                                  running.insert(key, {}).first->add(value);
                          });
    means_.reserve(running.size());
    running.for_each([&](NodeKey key, const Running& r) { means_.insert(key, r.mean); });
}

}  // namespace nestgrid
