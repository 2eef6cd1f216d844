// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <dune/common/parallel/mpihelper.hh>

#include <nestgrid/adapters/dune_fields.hpp>

#include "dune_transport.hpp"
#include "solver_slices.hpp"

void slices_dune(bool quick) {
    int no_arguments = 0;
    char** none = nullptr;
    Dune::MPIHelper::instance(no_arguments, none);
    dune_transport::Transport problem;
    do problem.solve();
    while (problem.refine(quick ? 0.5 : 0.045));
    const nestgrid::DuneGrid grid(*problem.grid);
    const nestgrid::DuneVertexField field(grid, problem.solution);
    const auto on_boundary = [](const nestgrid::Point& x) {
        return on_boundary_of_box(x, {1, 1, 1});
    };
    measure_slices({"dune_ug", on_boundary, quick}, nestgrid::erase(grid, field));
}
