// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A distributed grid and a field on it, from what each rank has (docs/distributed.md).
//
// Every rank calls the same algorithms in the same order, with the same options, and gets its piece
// of the result. All pieces together are the result of one rank, to the last bit.
#pragma once

#include <nestgrid/algorithms/detail/share_on_ranks.hpp>

namespace nestgrid {

/// A grid that says by `presence` (optional.hpp) which leaves this rank has. A copy of that grid,
/// for one state of it: to be made anew, on all ranks, once the grid has changed.
/// Ranks list the same coarse elements; or each lists its own and those beside these, and the grid
/// says by `std::uint64_t coarse_place(std::size_t i) const` where each is in the order of one
/// rank. It may say by `int rank_count() const` over how many processes it is distributed.
template <class Grid>
class Distributed : public Grid {
    static_assert(may_offer<Grid>(Feature::presence),
                  "A distributed grid must define 'Presence presence(const Element&) const', which "
                  "says which leaves of an element this process has.");

public:
    /// Collective. \param ranks borrowed
    /// \param most_sharers at how many ranks a node is told to all, instead of to each other
    ///
    /// \throw InvalidInput or GridError, on all ranks alike, where the grid cannot be drawn on
    ///        ranks, is on another number of them, or its keys differ between them
    Distributed(const Grid& grid, Ranks& ranks, std::size_t most_sharers = 24) : Grid(grid) {
        const ZeroField<Grid> zero;
        const Grid& mine = *this;
        shared_ =
            detail::share_nodes(erase(mine, zero), ranks, most_sharers, detail::on_ranks(mine));
    }
    const engine::SharedNodes* shared_nodes() const { return shared_.get(); }

private:
    std::shared_ptr<const engine::SharedNodes> shared_;
};

/// A field on the part of a grid that this rank has. Where it says that values are missing, they
/// come from the least rank that has them. A copy of that field, for one state of its values: to be
/// made anew, on all ranks, once they have changed.
template <class Grid, class Field>
class DistributedField : public Field {
public:
    /// Collective.
    ///
    /// \throw InvalidInput, on all ranks alike, where ranks have different values at one node
    DistributedField(const Distributed<Grid>& on, const Field& field) : Field(field) {
        far_ = detail::share_values(erase(on, static_cast<const Field&>(*this)));
    }
    const engine::FarValues* far_values() const { return far_.get(); }

private:
    std::shared_ptr<const engine::FarValues> far_;
};

}  // namespace nestgrid
