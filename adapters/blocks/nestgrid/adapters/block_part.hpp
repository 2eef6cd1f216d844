// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The part of a block grid that one process has, where boxes are spread over processes (ranks).
// Every process knows all boxes, as those of AMReX do, so that nothing about the grid is asked of
// another one:
//
//     const BlockPart<3> mine(blocks, owners, rank);
//     const Distributed grid(mine, ranks);
//     const DistributedField field(grid, BlockCells<3, double>(mine, arrays));
//
// A value at a node needs the cells around it, also those of boxes of other ranks. So arrays hold
// copies of boxes beside those of the rank, or of their cells there; others are null. A node needs
// one rank that has them all: the others fetch the value.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nestgrid/adapters/block_grid.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// By level and number of the box.
using BlockOwners = std::vector<std::vector<int>>;

/// A block grid of whose leaves this process draws those in its own boxes.
template <int dim>
class BlockPart : public BlockGrid<dim> {
public:
    using Element = typename BlockGrid<dim>::Element;

    /// \param blocks of all ranks
    /// \param owners the rank of each box, less than there are ranks; the same on all of them
    /// \param rank this one
    ///
    /// \throw InvalidInput as BlockGrid, and where there is not one owner >= 0 for each box
    BlockPart(const Blocks<dim>& blocks, BlockOwners owners, int rank)
        : BlockGrid<dim>(blocks), owners_{std::move(owners)}, rank_{rank} {
        bool fits = owners_.size() == blocks.levels.size();
        for (std::size_t l = 0; fits && l < owners_.size(); ++l) {
            fits = owners_[l].size() == blocks.levels[l].boxes.size();
        }
        if (!fits) throw InvalidInput("there is not one owner for each box of each level");
        epoch_ = BlockGrid<dim>::epoch();
        for (const std::vector<int>& level : owners_) {
            for (const int owner : level) {
                if (owner < 0) {
                    throw InvalidInput("a box has the owner " + std::to_string(owner));
                }
                epoch_ = detail::mix64(epoch_ + static_cast<std::uint64_t>(std::int64_t{owner}));
            }
        }
    }

    /// O(boxes below the element).
    Presence presence(const Element& e) const {
        bool any = false;
        bool all = true;
        this->for_each_box_below(e, [&](std::size_t level, std::size_t box) {
            const bool is_mine = owners_[level][box] == rank_;
            any = any || is_mine;
            all = all && is_mine;
            return all || !any;
        });
        if (all) return Presence::here;
        if (!any) return Presence::elsewhere;
        const BlockCell<dim> first = this->leaf_at(this->corner(e, 0), BlockCell<dim>{});
        const int owner =
            owners_[static_cast<std::size_t>(first.level)][static_cast<std::size_t>(first.box)];
        return owner == rank_ ? Presence::partly_first : Presence::partly;
    }
    /// Changes with the boxes and with their owners.
    std::uint64_t epoch() const { return epoch_; }

private:
    BlockOwners owners_;
    int rank_;
    std::uint64_t epoch_ = 0;
};

}  // namespace nestgrid
