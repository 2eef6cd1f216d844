// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The solution of a problem of transport on red and green tetrahedra of UGGrid.
#include "dune_laws.hpp"
#include "dune_transport.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

TEST(DuneSolution, LawsHold) {
    dune_transport::Transport problem;
    do problem.solve();
    while (problem.refine(0.045));
    EXPECT_GE(problem.grid->size(0), 100'000);
    const DuneGrid grid(*problem.grid);
    const DuneVertexField field(grid, problem.solution);
    expect_sound_grid(grid, field, {.hanging_values = true});
    expect_closed_levels(grid, field, 0.5, 0.03);
}

}  // namespace
