// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// p4est: a blob carried round by a vortex, by finite volumes of second order on a forest of four
// octrees that follows it. Every so often the isosurface u = 0.5 is extracted straight from the
// forest: the means of cells stay where the solver keeps them, in the user data of quadrants, and
// nothing is open where the size of cells changes, nor where cells of several ranks meet.
//     [mpirun -n 4] p4est_advection [steps] [folder for surfaces] [--view]
// ParaView plays surface.pvd in that folder, also while the solver runs. With --view, on one rank,
// a page for browsers shows the surface, coloured by the exact solution, which is 0.5 where the
// solver is right.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include <nestgrid/adapters/mpi_files.hpp>
#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "p4est_advection.hpp"
#include "solver_page.hpp"

namespace {

using namespace p4est_advection;

constexpr int steps_per_surface = 30;

/// The surfaces in a folder, which ParaView plays.
class Film {
public:
    explicit Film(const std::string& folder) : folder_{folder} {}

    template <class Piece>
    void add(double time, nestgrid::MpiRanks& ranks, const Piece& piece,
             const nestgrid::JoinedPiece& joined) {
        char name[32];
        std::snprintf(name, sizeof name, "surface-%04d.vtp", frames_++);
        nestgrid::write_vtp(ranks, piece, joined, folder_ + "/" + name);
        list_ += "<DataSet timestep=\"" + std::to_string(time) + "\" file=\"" + name + "\"/>\n";
        if (ranks.rank() == 0) write_list();
    }

private:
    /// The list appears complete, by rename, or not at all.
    void write_list() const {
        const std::string path = folder_ + "/surface.pvd";
        std::ofstream file(path + ".part");
        file << "<VTKFile type=\"Collection\"><Collection>\n"
             << list_ << "</Collection></VTKFile>\n";
        file.close();
        if (!file) throw nestgrid::IoError(path + " could not be written");
        std::filesystem::rename(path + ".part", path);
    }

    std::string folder_;
    std::string list_;
    int frames_ = 0;
};

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double, std::milli>(now - start).count();
}

/// The surface with the exact solution as attributes.
nestgrid::Surface<3> coloured(nestgrid::Surface<3> surface, double time) {
    for (const nestgrid::Point& x : surface.vertices) surface.attributes.push_back(exact(x, time));
    return surface;
}

void print_heading() {
    std::printf(
        "step  time leaves levels     mass     drift L1 error      min   max triangles open"
        "   area  volume  ms: surface  solver\n");
}

void print_line(long step, const Advection& solver, const Totals& now, double drift, double error) {
    std::printf("%4ld %5.3f %6lld %4d-%d %8.6f %9.1e %8.4f %8.1e %5.3f ", step, solver.time(),
                static_cast<long long>(solver.forest()->global_num_quadrants),
                -std::ilogb(now.largest), -std::ilogb(now.smallest), now.mass, drift, error,
                now.least, now.greatest);
}

/// \return exit status: 1 where mass is lost, the surface is open, or the time step too long
int run(long steps, const std::string& folder, const ShowSurface& show) {
    nestgrid::MpiRanks ranks(MPI_COMM_WORLD);
    Advection solver;
    const double mass = Totals(solver).mass;
    Film film(folder);
    double solving = 0;
    if (ranks.rank() == 0) print_heading();
    for (long step = 0; step <= steps; ++step) {
        auto start = std::chrono::steady_clock::now();
        if (step > 0) solver.step();
        solving += milliseconds_since(start);
        if (step % steps_per_surface != 0 && step != steps) continue;

        // All there is to it: the grid, where a leaf keeps its value, the surface.
        start = std::chrono::steady_clock::now();
        const nestgrid::P4estGrid mine(solver.forest());
        const nestgrid::Distributed grid(mine, ranks);
        const nestgrid::CellAverages means(
            grid, [&](const auto& leaf) { return cell_of(mine.quadrant(leaf)).u; });
        const nestgrid::DistributedField field(grid, means);
        const auto piece = nestgrid::isosurface(grid, field, 0.5, {.threshold = 0.01});
        const double extracting = milliseconds_since(start);

        const auto joined = nestgrid::join_pieces(piece, grid);
        const auto whole = nestgrid::measure_pieces(piece, joined, grid).total;
        const Totals now(solver);
        const double drift = now.mass / mass - 1;
        if (ranks.rank() == 0) {
            print_line(step, solver, now, drift, now.error / mass);
            std::printf("%9llu %4llu %6.4f %7.5f %12.1f %7.0f\n",
                        static_cast<unsigned long long>(joined.simplices),
                        static_cast<unsigned long long>(joined.open), whole.area, whole.volume,
                        extracting, solving);
        }
        solving = 0;
        if (!(std::abs(drift) < 1e-12 && now.courant < 1) || joined.open > 0) return 1;
        if (show) {
            show({.surface = coloured(piece.surface, solver.time()),
                  .field = "exact solution",
                  .step = static_cast<std::uint64_t>(step),
                  .time = solver.time()});
        }
        if (!folder.empty()) film.add(solver.time(), ranks, piece, joined);
        if (ranks.rank() == 0 && step == steps && steps % Fineness{}.steps_per_rotation == 0) {
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
        if (views && processes > 1) throw InvalidInput("--view needs a run on one rank");
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
