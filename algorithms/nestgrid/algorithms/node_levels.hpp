// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The level of each node, for a criterion by level (paper, section 4) on any grid.
//
// Where bisection halves an edge on different levels in different elements, the level of an element
// says nothing of the node: S = (level > deepest) is no function of the node, and opens the
// surface. So a node has the level of the deepest element that makes it, and then at most that of
// any node created in elements it is a corner of: a saturated indicator.
// Memory: 2 bytes a node (with its key where keys are not dense).
#pragma once

#include <cmath>
#include <cstdint>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/detail/node_table.hpp>
#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

/// The level on which each node is made.
class NodeLevels final : public Indicator {
public:
    /// Walks the whole hierarchy.
    template <class Grid>
        requires(!std::derived_from<Grid, Hierarchy<float>>)
    explicit NodeLevels(const Grid& grid) : NodeLevels(erase(grid, ZeroField<Grid>{})) {}
    explicit NodeLevels(const Hierarchy<float>& hierarchy);

    /// The level of a node, 0 on the coarse grid; -1 at nodes where no element may stop.
    int level(NodeKey node) const { return -heights_.at(node); }
    /// 2^-level.
    double stop(NodeKey node) const override { return std::ldexp(1.0, -level(node)); }

    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }

    /// S(x) = (level of x > deepest). The levels must outlive the criterion.
    Threshold deeper_than(int deepest) const { return {this, std::ldexp(1.0, -deepest - 1)}; }

private:
    std::uint64_t epoch_;                      // of the grid
    detail::NodeTable<std::int16_t> heights_;  // minus the level
};

}  // namespace nestgrid
