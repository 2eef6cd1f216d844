// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/cell_data.hpp>

#include "p4est_advection.hpp"
#include "solver_slices.hpp"

void slices_p4est(bool quick) {
    sc_MPI_Init(nullptr, nullptr);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    {
        const p4est_advection::Fineness fine{
            .finest = 7, .largest_jump = 0.06, .steps_per_rotation = 720};
        p4est_advection::Advection solver(quick ? p4est_advection::Fineness{} : fine);
        for (int step = 0; step < (quick ? 8 : 60); ++step) solver.step();
        const nestgrid::P4estGrid grid(solver.forest());
        const nestgrid::CellAverages field(grid, [&](const auto& leaf) {
            return p4est_advection::cell_of(grid.quadrant(leaf)).u;
        });
        const auto on_boundary = [](const nestgrid::Point& x) {
            return on_boundary_of_box(x, {2, 2, 1});
        };
        measure_slices({"p4est", on_boundary, quick}, nestgrid::erase(grid, field));
    }
    sc_finalize();
    sc_MPI_Finalize();
}
