// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of MultiFabs in place, by a stand-in for AMReX.
#include <nestgrid/adapters/amrex.hpp>
#include <nestgrid/check_grid.hpp>

#include "amrex_stand_in.hpp"
#include "closedness.hpp"
#include "refusal_rows.hpp"

using namespace nestgrid_test;

namespace {

double wave(const Point& x, int component) {
    return std::sin(7 * x[0] + component) + std::cos(9 * x[1]) * (1 + x[2]) - 0.4;
}

/// The same surface as of the boxes themselves, for each component.
template <int dim, class Real>
void expect_same_as_blocks(int ghosts) {
    const CellRule rule = dim == 2 ? CellRule::sharp_means : CellRule::smooth;
    for (unsigned seed = 1; seed < 5; ++seed) {
        Blocks<dim> blocks = random_blocks<dim>({.seed = seed, .side = 4});
        blocks.origin = {3, -1, 0};
        const stand_in::Run<dim, Real> run(blocks, wave, 2, ghosts);
        const BlockGrid<dim> grid(amrex_blocks<dim>(run.levels, run.geometry, run.ratios));
        const BlockGrid<dim> own(blocks);
        for (const int component : {0, 1}) {
            const auto field = amrex_cells(grid, run.levels, component, rule);
            const BlockData<dim, Real> data(
                blocks, [&](const Point& x) { return wave(x, component); }, 0);
            const BlockCells<dim, Real> expected(own, data.arrays(), rule);
            const auto a = isosurface(grid, field, 0.0).surface;
            const auto b = isosurface(own, expected, 0.0).surface;
            EXPECT_GT(a.simplices.size(), 0U);
            EXPECT_EQ(a.vertices, b.vertices);
            EXPECT_EQ(a.simplices, b.simplices);
            const auto violation = check_grid(grid, field);
            EXPECT_FALSE(violation) << violation->sentence;
        }
    }
}

TEST(Amrex, IsReadInPlace) {
    expect_same_as_blocks<3, double>(1);
    expect_same_as_blocks<3, float>(0);
    expect_same_as_blocks<2, double>(2);
    expect_same_as_blocks<2, float>(1);
}

TEST(Amrex, OfNodesIsReadInPlace) {
    const Blocks<3> blocks = random_blocks<3>({.seed = 2, .side = 4});
    const stand_in::Run<3, double> run(blocks, wave, 2, 1, true);
    const BlockGrid<3> grid(amrex_blocks<3>(run.levels, run.geometry, run.ratios));
    const BlockGrid<3> own(blocks);
    EXPECT_EQ(grid.epoch(), own.epoch());
    const BlockData<3> data(
        blocks, [](const Point& x) { return wave(x, 1); }, 0, BlockCentring::nodes);
    const auto a = isosurface(grid, amrex_nodes(grid, run.levels, 1), 0.0).surface;
    const auto b = isosurface(own, BlockNodes<3, double>(own, data.arrays()), 0.0).surface;
    EXPECT_EQ(a.vertices, b.vertices);
    expect_closed(a);
}

TEST(Amrex, SaysWhatIsWrong) {
    RefusalRows rows("AMReX");
    const Blocks<3> blocks = random_blocks<3>({.seed = 1, .side = 4});
    const stand_in::Run<3, double> run(blocks, wave);
    const stand_in::Run<3, double> nodal(blocks, wave, 1, 0, true);
    const stand_in::Run<3, double> half(blocks, wave, 1, 0, false, 2);
    const BlockGrid<3> grid(amrex_blocks<3>(run.levels, run.geometry, run.ratios));
    rows.add("too few ratios", [&] {
        amrex_blocks<3>(run.levels, run.geometry, stand_in::Vector<stand_in::IntVect>());
    });
    rows.add("a component that is not there", [&] { amrex_cells(grid, run.levels, 2); });
    rows.add("nodes for cells", [&] { amrex_cells(grid, nodal.levels); });
    rows.add("cells for nodes", [&] { amrex_nodes(grid, run.levels); });
    rows.add("a level that the grid does not have", [&] {
        auto levels = run.levels;
        levels.push_back(levels[0]);
        amrex_cells(grid, levels);
    });
    rows.add<GridError>("boxes on another process",
                        [&] { isosurface(grid, amrex_cells(grid, half.levels), 0.0); });
}

}  // namespace
