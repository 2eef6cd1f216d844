// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Dune: salt in the ground water that flows over a salt dome, by linear finite elements with
// streamline diffusion. For each of several tolerances the tetrahedra of a UGGrid are refined, red
// and green, where the solution is curved, and the isosurface u = 0.5 is extracted straight from
// the solver's vector: nothing is copied.
//     dune_transport [tolerances] [folder for the last surface]
// The solution is known. The order is that of its error in L2 against the number of unknowns to the
// power of -1/3, and should be 2. It is taken over two tolerances, since a quarter of a tolerance
// is one level more.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <dune/common/parallel/mpihelper.hh>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/dune_fields.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "dune_transport.hpp"

namespace {

using namespace dune_transport;

constexpr double least_order = 1.8;

/// UG closes its grids by green tetrahedra: no node hangs.
struct Closed : nestgrid::DuneTraits<Grid> {
    static constexpr bool conforming = true;
};

template <class Surface>
void write(const Surface& surface, const std::string& file) {
    const vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetInputData(nestgrid::make_poly_data(surface));
    writer->SetFileName(file.c_str());
    if (writer->Write() != 1 || writer->GetErrorCode() != 0) {
        throw std::runtime_error(file + " could not be written");
    }
}

void run(long tolerances, const std::string& folder) {
    std::printf(
        "tolerance tetrahedra unknowns   L2 error  order triangles open edges area error\n");
    std::vector<double> errors, unknowns;
    for (long row = 0; row < tolerances; ++row) {
        const double tolerance = std::ldexp(1.0, static_cast<int>(-row));
        Transport problem;
        do problem.solve();
        while (problem.refine(tolerance));
        errors.push_back(problem.error());
        unknowns.push_back(static_cast<double>(problem.solution.size()));

        // All there is to it: the grid, the field, the surface, as exact as the solution.
        const nestgrid::DuneGrid<Grid, Closed> grid(*problem.grid);
        const nestgrid::DuneVertexField field(grid, problem.solution);
        const auto surface =
            nestgrid::isosurface(grid, field, 0.5, {.threshold = errors.back()}).surface;

        const auto report = nestgrid::surface_report(surface);
        const double exact_area = 2 * M_PI * Exact::radius * Exact::radius;
        std::printf("%9.4f %10d %8.0f %10.3e ", tolerance, problem.grid->size(0), unknowns.back(),
                    errors.back());
        double order = least_order;
        if (row < 2) std::printf("      ");
        if (row >= 2) {
            const auto before = static_cast<std::size_t>(row - 2);
            order = 3 * std::log(errors[before] / errors.back()) /
                    std::log(unknowns.back() / unknowns[before]);
            std::printf("%6.2f", order);
        }
        std::printf(" %9zu %10zu %9.2f%%\n", report.triangles, report.open_edges,
                    100 * std::abs(report.area / exact_area - 1));
        if (!(errors.back() < tolerance / 4)) {
            throw std::runtime_error("the error is more than a quarter of the tolerance");
        }
        if (report.open_edges > 0) throw std::runtime_error("the surface is open");
        if (!(order >= least_order)) {
            throw std::runtime_error("the error does not fall as it should: its order is below " +
                                     std::to_string(least_order));
        }
        if (!folder.empty() && row + 1 == tolerances) write(surface, folder + "/salt.vtp");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Dune::MPIHelper::instance(argc, argv);
    try {
        char* end = nullptr;
        const long tolerances = argc > 1 ? std::strtol(argv[1], &end, 10) : 6;
        const std::string folder = argc > 2 ? argv[2] : "";
        if (argc > 3)
            throw std::runtime_error("there are more arguments than [tolerances] [folder]");
        if (tolerances < 1 || (end != nullptr && *end != '\0')) {
            throw std::runtime_error(std::string("this is not a number of tolerances: ") + argv[1]);
        }
        if (argc > 2 && !std::filesystem::is_directory(folder)) {
            throw std::runtime_error("there is no folder " + folder);
        }
        run(tolerances, folder);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "dune_transport: %s\n", e.what());
        return 1;
    }
    return 0;
}
