// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// p4est: a blob carried round by a vortex, by finite volumes of second order on a forest of four
// octrees that follows it. Every so often the isosurface u = 0.5 is extracted straight from the
// forest: the means of cells stay where the solver keeps them, in the user data of quadrants, and
// nothing is open where the size of cells changes.
//     p4est_advection [steps] [folder for surfaces] [--view]
// ParaView plays surface.pvd in that folder, also while the solver runs. With --view a page for
// browsers shows the surface, coloured by the exact solution, which is 0.5 where the solver is
// right.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "p4est_advection.hpp"
#include "solver_page.hpp"

namespace {

using namespace p4est_advection;

constexpr int steps_per_surface = 30;

/// Writes files that appear complete, by rename, or not at all.
template <class Write>
void publish(const std::string& path, const Write& write) {
    if (!write(path + ".part")) throw nestgrid::IoError(path + " could not be written");
    std::filesystem::rename(path + ".part", path);
}

/// Adds a surface to the film in a folder. \param list of the surfaces so far
template <class Surface>
void write(const std::string& folder, double time, const Surface& surface, std::string& list) {
    const auto number = std::count(list.begin(), list.end(), '\n');
    char name[32];
    std::snprintf(name, sizeof name, "surface-%04d.vtp", static_cast<int>(number));
    publish(folder + "/" + name, [&](const std::string& path) {
        const vtkNew<vtkXMLPolyDataWriter> writer;
        writer->SetInputData(nestgrid::make_poly_data(surface));
        writer->SetFileName(path.c_str());
        return writer->Write() == 1 && writer->GetErrorCode() == 0;
    });
    list += "<DataSet timestep=\"" + std::to_string(time) + "\" file=\"" + name + "\"/>\n";
    publish(folder + "/surface.pvd", [&](const std::string& path) {
        std::ofstream file(path);
        file << "<VTKFile type=\"Collection\"><Collection>\n"
             << list << "</Collection></VTKFile>\n";
        return !file.flush().fail();
    });
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - start).count();
}

/// The surface with the exact solution as attributes.
nestgrid::Surface<3> coloured(nestgrid::Surface<3> surface, double time) {
    for (const nestgrid::Point& x : surface.vertices) surface.attributes.push_back(exact(x, time));
    return surface;
}

/// \return exit status: 1 where mass is lost, the surface is open, or the time step too long
int run(long steps, const std::string& folder, const ShowSurface& show) {
    Advection solver;
    const double mass = Totals(solver).mass;
    std::string list;
    double solving = 0;
    std::printf(
        "step  time leaves levels     mass     drift L1 error      min   max triangles open"
        "   area  volume  ms: surface  solver\n");
    for (long step = 0; step <= steps; ++step) {
        auto start = std::chrono::steady_clock::now();
        if (step > 0) solver.step();
        solving += milliseconds_since(start);
        if (step % steps_per_surface != 0 && step != steps) continue;

        // All there is to it: the grid, where a leaf keeps its value, the surface.
        start = std::chrono::steady_clock::now();
        const nestgrid::P4estGrid grid(solver.forest());
        const nestgrid::CellAverages field(
            grid, [&](const auto& leaf) { return cell_of(grid.quadrant(leaf)).u; });
        const auto surface = nestgrid::isosurface(grid, field, 0.5, {.threshold = 0.01}).surface;
        const double extracting = milliseconds_since(start);
        if (show) {
            show({.surface = coloured(surface, solver.time()),
                  .field = "exact solution",
                  .step = static_cast<std::uint64_t>(step),
                  .time = solver.time()});
        }

        const Totals now(solver);
        const double drift = now.mass / mass - 1;
        const auto report = nestgrid::surface_report(surface);
        std::printf(
            "%4ld %5.3f %6zu %4d-%d %8.6f %9.1e %8.4f %8.1e %5.3f %9zu %4zu %6.4f %7.5f "
            "%12.1f %7.0f\n",
            step, solver.time(), grid.leaf_count(), -std::ilogb(now.largest),
            -std::ilogb(now.smallest), now.mass, drift, now.error / mass, now.least, now.greatest,
            report.triangles, report.open_edges, report.area, report.volume, extracting, solving);
        solving = 0;
        if (!(std::abs(drift) < 1e-12 && now.courant < 1) || report.open_edges > 0) return 1;
        if (!folder.empty()) write(folder, solver.time(), surface, list);
        if (step == steps && steps % Fineness{}.steps_per_rotation == 0) {
            std::printf("back at the beginning, off by %.1f %% in L1\n", 100 * now.error / mass);
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    sc_MPI_Init(&argc, &argv);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    int status = 1;
    try {
        const bool views = take_view_option(argc, argv);
        int processes = 0;
        sc_MPI_Comm_size(sc_MPI_COMM_WORLD, &processes);
        char* end = nullptr;
        const long steps =
            argc > 1 ? std::strtol(argv[1], &end, 10) : Fineness{}.steps_per_rotation;
        const std::string folder = argc > 2 ? argv[2] : "";
        using nestgrid::InvalidInput;
        if (processes > 1) throw InvalidInput("this example runs in one process");
        if (argc > 3) throw InvalidInput("there are more arguments than [steps] [folder] [--view]");
        if (steps < 1 || (end != nullptr && *end != '\0')) {
            throw InvalidInput(std::string("this is not a number of steps: ") + argv[1]);
        }
        if (argc > 2 && !std::filesystem::is_directory(folder)) {
            throw InvalidInput("there is no folder " + folder);
        }
        ShowSurface show;
        if (views) show = show_in_page("A blob in a vortex", {{{0, 0, 0}, {2, 2, 1}}});
        status = run(steps, folder, show);
        if (views) wait_for_enter();
    } catch (const std::exception& e) {
        if (sc_is_root()) std::fprintf(stderr, "p4est_advection: %s\n", e.what());
    }
    sc_finalize();
    sc_MPI_Finalize();
    return status;
}
