// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A distributed grid and a field on it, from what each rank has (docs/distributed.md).
//
// Every rank calls the same algorithms in the same order, with the same options, and gets its piece
// of the result. All pieces together are the result of one rank, to the last bit.
#pragma once

#include <functional>
#include <memory>

#include <nestgrid/algorithms/ranks.hpp>
#include <nestgrid/detail/erase.hpp>

namespace nestgrid {

namespace detail {

/// Finds the nodes that this rank shares with others, and the hanging ones. Collective.
/// \param most_sharers nodes that more ranks have are told to all
/// \param place of coarse elements; nothing where these are the same on all ranks
std::shared_ptr<const engine::SharedNodes> share_nodes(
    const Hierarchy<float>& grid, Ranks& ranks, std::size_t most_sharers,
    const std::function<std::uint64_t(std::size_t)>& place = {});
/// Fetches the values at shared nodes that the field lacks on this rank. Collective.
std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<float>& field);
std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<double>& field);

}  // namespace detail

/// A grid that says by `presence` (optional.hpp) which leaves this rank has. A copy of that grid,
/// for one state of it: to be made anew, on all ranks, once the grid has changed.
/// Ranks list the same coarse elements; or each lists its own and those beside these, and the grid
/// says by `std::uint64_t coarse_place(std::size_t i) const` where each is in the order of one
/// rank.
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
    ///        ranks, or its keys differ between them
    Distributed(const Grid& grid, Ranks& ranks, std::size_t most_sharers = 24) : Grid(grid) {
        const ZeroField<Grid> zero;
        std::function<std::uint64_t(std::size_t)> place;
        if constexpr (requires { this->coarse_place(std::size_t{}); }) {
            place = [this](std::size_t i) { return this->coarse_place(i); };
        }
        shared_ = detail::share_nodes(erase(static_cast<const Grid&>(*this), zero), ranks,
                                      most_sharers, place);
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
