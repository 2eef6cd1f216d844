// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "p4est_samples.hpp"
#include "solver_runs.hpp"

using namespace nestgrid_test;

Run run_p4est(int levels) {
    MPI_Init(nullptr, nullptr);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_SILENT);
    p4est_init(nullptr, SC_LP_SILENT);
    Run run;
    {
        const auto ball = [](const Point& x) { return 0.35 - norm(x - Point{0.51, 0.49, 0.5}); };
        Forest<3> forest(p8est_connectivity_new_unitcube());
        forest.refine([&](const p8est_quadrant_t& q) {
            const double half = std::ldexp(0.5, -q.level);
            const auto at = [&](auto x) { return std::ldexp(x, -P8EST_MAXLEVEL) + half; };
            return q.level < levels && std::abs(ball({at(q.x), at(q.y), at(q.z)})) < 2 * half;
        });
        forest.balance();
        const auto nodes = forest.nodes();
        const std::vector<double> values = nodal_values(P4estGrid(forest.get()), *nodes, ball);
        const auto start = Clock::now();
        const P4estGrid grid(forest.get());
        const P4estNodalField field(grid, nodes.get(), std::span<const double>(values));
        run = time_both(grid, field, start);
        run.leaves = static_cast<double>(grid.leaf_count());
    }
    MPI_Finalize();
    return run;
}
