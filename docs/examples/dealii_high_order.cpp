// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// deal.II, hp: in every cycle of a solver whose cells have degrees of their own an isosurface, and
// a slice coloured by the error against the exact solution, straight from the solver's vector. Both
// are within a tolerance of the polynomials, and nothing is open where size or degree changes.
//     dealii_high_order [cycles] [folder for surfaces]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "dealii_high_order.hpp"

namespace {

constexpr double tolerance = 1e-3;

/// Replaces the solution at the vertices of a slice by its error.
/// \return the greatest
double turn_into_errors(nestgrid::Surface<3>& slice, const dealii::Function<3>& exact) {
    double greatest = 0;
    for (std::size_t i = 0; i < slice.vertices.size(); ++i) {
        const auto& [x, y, z] = slice.vertices[i];
        slice.attributes[i] = std::abs(slice.attributes[i] - exact.value({x, y, z}));
        greatest = std::max(greatest, slice.attributes[i]);
    }
    return greatest;
}

bool write(const nestgrid::Surface<3>& surface, const std::string& path) {
    const vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(nestgrid::make_poly_data(surface, {"error"}));
    writer->SetFileName(path.c_str());
    writer->Write();
    return writer->GetErrorCode() == 0;
}

int run(int argc, char** argv) {
    const int cycles = argc > 1 ? std::atoi(argv[1]) : 5;
    const std::string folder = argc > 2 ? argv[2] : "";
    const dealii_high_order::Exact exact;
    dealii_high_order::Laplace problem(exact);
    std::printf(
        "cycle  cells    dofs  degrees  L2 error     jump  triangles  open    bound  slice  open   "
        " "
        "bound   error\n");
    for (int cycle = 0; cycle < cycles; ++cycle) {
        if (cycle > 0) problem.refine();
        problem.solve();

        // [dealii_high_order]
        const nestgrid::DealiiGrid<3> grid(problem.triangulation);
        const nestgrid::DealiiField field(grid, problem.dofs, problem.solution);
        const nestgrid::HighOrder data(grid, field);
        // Where the space itself jumps, this is a part of what is left of the tolerance.
        const double left = tolerance - std::min(data.jump(), tolerance / 2);
        const nestgrid::VirtualRefinement fine(data, {.tolerance = left});
        const auto surface =
            nestgrid::isosurface<3>(fine, 0.5, under(fine.criterion(), fine.bounds()));
        auto slice = nestgrid::slice(fine, nestgrid::Plane({0, 0, 0.3}, {0, 0, 1}),
                                     under(fine.criterion(), fine.bounds()));
        // [dealii_high_order]

        const auto closed = nestgrid::surface_report(surface.surface);
        const auto whole = nestgrid::surface_report(slice.surface);
        const double error = turn_into_errors(slice.surface, exact);
        std::printf("%5d %6u %7u %8zu %9.2e %8.6f %10zu %5zu %8.1e %6zu %5zu %8.1e %7.1e\n", cycle,
                    problem.triangulation.n_active_cells(), problem.dofs.n_dofs(),
                    problem.degree_count(), problem.error(), data.jump(),
                    surface.surface.simplices.size(), std::size_t(closed.open_edges),
                    surface.error_bound, slice.surface.simplices.size(),
                    std::size_t(whole.open_edges), slice.error_bound, error);
        const bool limited = surface.counts.limited > 0 || slice.counts.limited > 0;
        const bool within = surface.error_bound <= tolerance && slice.error_bound <= tolerance;
        if (closed.open_edges + whole.open_edges > 0 || limited || !within) return 1;
        const std::string number = "-" + std::to_string(cycle) + ".vtp";
        if (!folder.empty() && (!write(surface.surface, folder + "/surface" + number) ||
                                !write(slice.surface, folder + "/slice" + number))) {
            std::fprintf(stderr, "nothing could be written to %s\n", folder.c_str());
            return 1;
        }
    }
    return problem.has_hanging_faces() && problem.degree_count() >= 3 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dealii_high_order: %s\n", e.what());
        return 1;
    }
}
