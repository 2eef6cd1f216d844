// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What ranks find out together about a distributed grid and a field on it. For distributed.hpp.
#pragma once

#include <functional>
#include <memory>

#include <nestgrid/algorithms/ranks.hpp>
#include <nestgrid/detail/erase.hpp>

namespace nestgrid::detail {

/// What a distributed grid may tell beside `presence` (optional.hpp).
struct GridOnRanks {
    int rank_count = 0;  ///< of processes over which it is distributed; 0: it does not say
    /// Of coarse elements; nothing where these are the same on all ranks.
    std::function<std::uint64_t(std::size_t)> place;
};

/// \param grid must outlive the result
template <class Grid>
GridOnRanks on_ranks(const Grid& grid) {
    GridOnRanks says;
    if constexpr (requires { grid.rank_count(); }) says.rank_count = grid.rank_count();
    if constexpr (requires { grid.coarse_place(std::size_t{}); }) {
        says.place = [&grid](std::size_t i) { return grid.coarse_place(i); };
    }
    return says;
}

/// Finds the nodes that this rank shares with others, and the hanging ones. Collective.
/// \param most_sharers nodes that more ranks have are told to all
///
/// \throw InvalidInput also where there are more or fewer ranks than the grid says, before any
///        exchange
std::shared_ptr<const engine::SharedNodes> share_nodes(const Hierarchy<float>& grid, Ranks& ranks,
                                                       std::size_t most_sharers,
                                                       const GridOnRanks& says = {});
/// Fetches the values at shared nodes that the field lacks on this rank. Collective.
std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<float>& field);
std::shared_ptr<const engine::FarValues> share_values(const Hierarchy<double>& field);

}  // namespace nestgrid::detail
