// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Space cut into boxes with about equally many vertices of a surface, and its triangles by box.
#pragma once

#include <distances/box_tree.hpp>

namespace nestgrid::engine {

class Blocks {
public:
    using Corners = std::array<std::uint32_t, 3>;

    /// \param positions of vertices
    /// \param most vertices in a block, but where they coincide
    /// \param cut the part of the vertices on the lower side of each cut, between 0 and 1
    Blocks(std::span<const Point> positions, std::size_t most, double cut);

    std::size_t count() const { return regions_.size(); }
    /// The box that the block fills. It extends to infinity where no other block follows.
    const Box& region(std::size_t block) const { return regions_[block]; }
    std::uint32_t block_of(std::uint32_t vertex) const { return block_of_[vertex]; }
    /// Calls function(block) for those that a box meets.
    template <class Function>
    void for_each_meeting(const Box& box, const Function& function) const {
        for_each_below(0, box, function);
    }

private:
    /// A cut of a region into two, or a block.
    struct Node {
        std::size_t axis = 0;
        double at = 0;
        std::uint32_t upper = 0;  ///< node above the cut; that below it is the next one
        std::uint32_t block = 0;
        bool is_block = true;
    };

    void divide(std::span<const Point> x, std::span<std::uint32_t> vertices, const Box& region,
                std::size_t most, double cut);

    template <class Function>
    void for_each_below(std::uint32_t node, const Box& box, const Function& function) const {
        const Node& n = nodes_[node];
        if (n.is_block) return function(n.block);
        if (box.low[n.axis] <= n.at) for_each_below(node + 1, box, function);
        if (box.high[n.axis] >= n.at) for_each_below(n.upper, box, function);
    }

    std::vector<std::uint32_t> block_of_;
    std::vector<Box> regions_;
    std::vector<Node> nodes_;
};

}  // namespace nestgrid::engine
