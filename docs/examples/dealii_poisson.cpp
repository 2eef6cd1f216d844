// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II: Laplace's equation around an edge that reenters, by adaptive geometric multigrid. In
// every cycle the isosurface u = 0.5 is extracted straight from the solver's vector: nothing is
// copied, and nothing is open where the size of cells changes, nor where cells of several ranks
// meet.
//     [mpirun -n 4] dealii_poisson [cycles] [folder for surfaces] [--view]
// With --view, on one rank, a page for browsers shows the surface, coloured by the exact solution,
// which is 0.5 where the solver is right.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "dealii_poisson.hpp"
#include "solver_page.hpp"

namespace {

/// The surface with the exact solution as attributes.
nestgrid::Surface<3> coloured(nestgrid::Surface<3> surface, const dealii_poisson::Exact& exact) {
    for (const auto& [x, y, z] : surface.vertices) {
        surface.attributes.push_back(exact.value({x, y, z}));
    }
    return surface;
}

/// \return exit status
int run(int cycles, const std::string& folder, const ShowSurface& show) {
    nestgrid::MpiRanks ranks(MPI_COMM_WORLD);
    const dealii_poisson::Exact exact;
    dealii_poisson::Laplace problem(exact);
    if (ranks.rank() == 0) {
        std::printf("cycle   cells    dofs  CG   L2 error  triangles  open edges  forgotten\n");
    }
    for (int cycle = 0; cycle < cycles; ++cycle) {
        if (cycle > 0) problem.refine();
        problem.setup();
        problem.assemble();
        const unsigned iterations = problem.solve();

        // All there is to it: the grid, the field, the surface.
        // [surface]
        const nestgrid::DealiiGrid<3> mine(problem.triangulation);
        const nestgrid::Distributed grid(mine, ranks);
        const nestgrid::DistributedField field(
            grid, nestgrid::DealiiField(mine, problem.dofs, problem.solution));
        const nestgrid::HierarchicalIndicator indicator(grid, field);
        const auto piece = nestgrid::isosurface(grid, field, 0.5, under(indicator, 1e-4));
        const auto joined = nestgrid::join_pieces(piece, grid);
        // [surface]

        const double error = problem.error();
        if (ranks.rank() == 0) {
            std::printf(
                "%5d %7llu %7llu %3u %10.3e %10llu %11llu %10.1e\n", cycle,
                static_cast<unsigned long long>(problem.triangulation.n_global_active_cells()),
                static_cast<unsigned long long>(problem.dofs.n_dofs()), iterations, error,
                static_cast<unsigned long long>(joined.simplices),
                static_cast<unsigned long long>(joined.open), indicator.hanging_violation());
        }
        if (joined.open > 0) return 1;
        if (show) {
            show({.surface = coloured(piece.surface, exact),
                  .field = "exact solution",
                  .step = static_cast<std::uint64_t>(cycle)});
        }
        if (!folder.empty()) {
            nestgrid::write_vtp(ranks, piece, joined,
                                folder + "/surface-" + std::to_string(cycle) + ".vtp");
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
    try {
        ShowSurface show;
        const bool views = take_view_option(argc, argv);
        if (views && dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) {
            throw nestgrid::InvalidInput("--view needs a run on one rank");
        }
        if (views) show = show_in_page("Around a reentrant edge", {{{-1, -1, 0}, {1, 1, 1}}});
        const int status = run(argc > 1 ? std::atoi(argv[1]) : 5, argc > 2 ? argv[2] : "", show);
        if (views) wait_for_enter();
        return status;
    } catch (const std::exception& e) {
        if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0) {
            std::fprintf(stderr, "dealii_poisson: %s\n", e.what());
        }
        return 1;
    }
}
