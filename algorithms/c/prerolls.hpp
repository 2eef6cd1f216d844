// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Indicators of one grid and field that several calls of a C code share.
#pragma once

#include <mutex>
#include <optional>

#include <nestgrid/algorithms/options.h>
#include <nestgrid/algorithms/prerolls.hpp>

#include "ranks_in_c.hpp"

/// Several calls may ask at once; the one that comes first computes.
struct nestgrid_prerolls {
public:
    /// The prerolls of the tables that are asked for first. Their hierarchy is that of a call: work
    /// names its own (Work::same_field).
    /// \throw nestgrid::InvalidInput where the tables are of another grid or field
    nestgrid::Prerolls& of(const nestgrid_grid& grid, const nestgrid_field& field,
                           const nestgrid::FieldOnGrid& hierarchy);

    /// The nodes and values that ranks share, made of the tables of the first call. Collective.
    std::shared_ptr<const nestgrid::PartOnRanks> part_of(const nestgrid_ranks& ranks,
                                                         const nestgrid_grid& grid,
                                                         const nestgrid::FieldOnGrid& hierarchy);

private:
    std::mutex mutex_;
    const void* grid_ = nullptr;  // `self` of the tables
    const void* field_ = nullptr;
    std::shared_ptr<const nestgrid::PartOnRanks> part_;
    std::optional<nestgrid::Prerolls> prerolls_;
};
