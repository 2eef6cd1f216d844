// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <dune/common/parallel/mpihelper.hh>

#include "dune_ug_grids.hpp"
#include "solver_runs.hpp"

using namespace nestgrid_test;

Run run_dune_ug(int levels) {
    int no_arguments = 0;
    char** none = nullptr;
    Dune::MPIHelper::instance(no_arguments, none);
    const auto solver = simplices<3>(4);
    refine_at_sphere(*solver, levels, 0.17);
    const std::vector<double> values = at_vertices(*solver, ball);
    const auto start = Clock::now();
    const DuneGrid grid(*solver);
    Run run = time_both(grid, DuneVertexField(grid, values), start);
    run.leaves = solver->size(0);
    return run;
}
