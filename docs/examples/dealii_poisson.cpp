// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II: Laplace's equation around an edge that reenters, by adaptive geometric multigrid. In
// every cycle the isosurface u = 0.5 is extracted straight from the solver's vector: nothing is
// copied, and nothing is open where the size of cells changes.
//     dealii_poisson [cycles] [folder for surfaces] [--view]
// With --view a page for browsers shows the surface, coloured by the exact solution, which is 0.5
// where the solver is right.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

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

int run(int argc, char** argv, const ShowSurface& show) {
    const int cycles = argc > 1 ? std::atoi(argv[1]) : 5;
    const std::string folder = argc > 2 ? argv[2] : "";
    const dealii_poisson::Exact exact;
    dealii_poisson::Laplace problem(exact);
    std::printf("cycle   cells    dofs  CG   L2 error  triangles  open edges  forgotten\n");
    for (int cycle = 0; cycle < cycles; ++cycle) {
        if (cycle > 0) problem.refine();
        problem.setup();
        problem.assemble();
        const unsigned iterations = problem.solve();

        // All there is to it: the grid, the field, the surface.
        const nestgrid::DealiiGrid<3> grid(problem.triangulation);
        const nestgrid::DealiiField field(grid, problem.dofs, problem.solution);
        const nestgrid::HierarchicalIndicator indicator(grid, field);
        const auto result = nestgrid::isosurface(grid, field, 0.5, under(indicator, 1e-4));

        const auto report = nestgrid::surface_report(result.surface);
        std::printf("%5d %7u %7u %3u %10.3e %10zu %11zu %10.1e\n", cycle,
                    problem.triangulation.n_active_cells(), problem.dofs.n_dofs(), iterations,
                    problem.error(), result.surface.simplices.size(),
                    static_cast<std::size_t>(report.open_edges), indicator.hanging_violation());
        if (report.open_edges > 0) return 1;
        if (show) {
            show({.surface = coloured(result.surface, exact),
                  .field = "exact solution",
                  .step = static_cast<std::uint64_t>(cycle)});
        }
        if (!folder.empty()) {
            const vtkNew<vtkXMLPolyDataWriter> writer;
            writer->SetInputData(nestgrid::make_poly_data(result.surface));
            writer->SetFileName((folder + "/surface-" + std::to_string(cycle) + ".vtp").c_str());
            writer->Write();
            if (writer->GetErrorCode() != 0) {
                std::fprintf(stderr, "a surface could not be written to %s\n", folder.c_str());
                return 1;
            }
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        ShowSurface show;
        const bool views = take_view_option(argc, argv);
        if (views) show = show_in_page("Around a reentrant edge", {{{-1, -1, 0}, {1, 1, 1}}});
        const int status = run(argc, argv, show);
        if (views) wait_for_enter();
        return status;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dealii_poisson: %s\n", e.what());
        return 1;
    }
}
