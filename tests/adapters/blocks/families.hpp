// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The families of blocks, for the laws that other tests state of stored hierarchies.
#pragma once

#include "adapted_blocks.hpp"
#include "fields_at_sphere.hpp"

namespace nestgrid_test {

template <int dim>
struct AdaptedBlocksFamily {
    using Grid = AdaptedBlocks<dim>;
    static constexpr int steps = 1;
    /// With roots above level 0 and without, by ratios of two, and of four and two.
    static std::vector<Grid> grids() { return {Grid(4, {2, 2}), Grid(3, {4, 2})}; }
};

using Families = testing::Types<AdaptedBlocksFamily<2>, AdaptedBlocksFamily<3>>;

}  // namespace nestgrid_test
