// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AlbertaGrid, of the dimension ALBERTA_DIM, as a nested grid.
#include "dune_alberta_grids.hpp"
#include "dune_laws.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

constexpr int dim = alberta_dimension;

TEST(DuneAlberta, Bisection) {
    const auto solver = bisected(dim, 3 * dim, 0.3);
    EXPECT_GT(solver->leafGridView().size(0), 200);
    const DuneGrid grid(*solver);
    EXPECT_TRUE(grid.conforming());
    EXPECT_LE(grid.rules().size(), 3U);
    expect_laws(*solver);
}

TEST(DuneAlberta, ManyElements) {
    const auto solver = bisected(2 * dim, dim == 3 ? 12 : 16, 0.3);
    EXPECT_GT(solver->leafGridView().size(0), dim == 3 ? 100'000 : 10'000);
    const DuneGrid grid(*solver);
    expect_sound(grid, 1);
    expect_closed_at_all_thresholds(grid, at_vertices(*solver, ball));
}

TEST(DuneAlberta, RefusesOtherThreads) {
    const auto solver = bisected(dim, dim, 0.3);
    expect_one_thread_only(DuneGrid(*solver));
}

}  // namespace
