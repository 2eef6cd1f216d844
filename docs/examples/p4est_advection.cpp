// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// p4est: a blob carried round by a vortex, by finite volumes of second order on a forest of four
// octrees that follows it. Every so often the isosurface u = 0.5 is extracted straight from the
// forest: the means of cells stay where the solver keeps them, in the user data of the quadrants,
// and nothing is open where the size of cells changes.
//     p4est_advection [steps] [folder for surfaces]
// ParaView plays surface.pvd in that folder, also while the solver runs.
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_iterate.h>

#include <vtkNew.h>
#include <vtkXMLPolyDataWriter.h>

#include <nestgrid/adapters/p4est.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

namespace {

using Vector = std::array<double, 3>;

constexpr int coarsest = 2;
constexpr int finest = 6;
constexpr int steps_per_rotation = 600;  // Courant numbers up to 0.76 in the finest cells
constexpr int steps_per_adaptation = 3;
constexpr int steps_per_surface = 30;
constexpr double largest_jump = 0.04;  // between neighbours; larger ones are refined

// The vortex, around the axis x = y = 1: as a solid, once in a unit of time, up to 0.8 from it,
// then ever slower, at rest from 1 on. So nothing flows through the walls.

constexpr double solid = 0.8 * 0.8;

double distance_squared(double x, double y) { return (x - 1) * (x - 1) + (y - 1) * (y - 1); }
double slowing(double q) { return std::clamp((q - solid) / (1 - solid), 0.0, 1.0); }

Vector velocity(const Vector& x) {
    const double rate = 2 * M_PI * (1 - slowing(distance_squared(x[0], x[1])));
    return {-rate * (x[1] - 1), rate * (x[0] - 1), 0};
}

/// The stream function: its differences are flows through faces, so the flows into a cell add up to
/// nothing, whatever the sizes of its neighbours.
double stream(double x, double y) {
    const double q = distance_squared(x, y);
    const double s = slowing(q);
    return -M_PI * (std::min(q, solid) + (1 - solid) * (s - s * s / 2));
}

/// Volume that flows through a square face per unit of time, in the direction of axis `normal`.
double flow(std::size_t normal, const Vector& centre, double size) {
    const auto [x, y, z] = centre;
    const double half = size / 2;
    if (normal == 0) return size * (stream(x, y + half) - stream(x, y - half));
    if (normal == 1) return size * (stream(x - half, y) - stream(x + half, y));
    return 0;
}

/// The solution: an ellipsoidal bump with u = 1 in its middle, turned around the axis.
double exact(const Vector& x, double time) {
    const double c = std::cos(2 * M_PI * time);
    const double s = std::sin(2 * M_PI * time);
    const double r = std::hypot((c * (x[0] - 1) + s * (x[1] - 1) - 0.4) / 0.3,
                                (c * (x[1] - 1) - s * (x[0] - 1)) / 0.18, (x[2] - 0.5) / 0.4);
    return r < 1 ? std::pow(std::cos(M_PI / 2 * r), 2) : 0;
}

/// What the solver keeps in the user data of each quadrant.
struct Cell {
    Vector centre{};
    double size = 0;
    double u = 0;                   ///< mean over the cell
    double gain = 0;                ///< of u times volume, in this step
    std::array<double, 6> slope{};  ///< of u across each face

    double volume() const { return size * size * size; }

    /// The slope in the direction of an axis: central, unless a face has less than half of it.
    double limited_slope(std::size_t axis) const {
        const double a = slope[2 * axis];
        const double b = slope[2 * axis + 1];
        if (a * b <= 0) return 0;
        return std::copysign(std::min(2 * std::min(std::abs(a), std::abs(b)), std::abs(a + b) / 2),
                             a);
    }
    double value(const Vector& x) const {
        double result = u;
        for (std::size_t d = 0; d < 3; ++d) result += limited_slope(d) * (x[d] - centre[d]);
        return result;
    }
    /// The largest difference from a neighbour of the same size.
    double jump() const {
        const auto [least, greatest] = std::minmax_element(slope.begin(), slope.end());
        return size * std::max(-*least, *greatest);
    }
};

Cell& cell_of(const p8est_quadrant_t& q) { return *static_cast<Cell*>(q.p.user_data); }

// What p4est calls while the forest changes.

void create(p8est_t* forest, p4est_topidx_t tree, p8est_quadrant_t* q) {
    Cell& cell = *new (q->p.user_data) Cell;
    const p4est_qcoord_t half = P8EST_QUADRANT_LEN(q->level) / 2;
    p8est_qcoord_to_vertex(forest->connectivity, tree, q->x + half, q->y + half, q->z + half,
                           cell.centre.data());
    cell.size = std::ldexp(1.0, -q->level);
}

/// Eight cells take the place of one or one that of eight, with the same total of u.
void replace(p8est_t*, p4est_topidx_t, int, p8est_quadrant_t* outgoing[], int incoming_count,
             p8est_quadrant_t* incoming[]) {
    if (incoming_count == 1) {
        Cell& father = cell_of(*incoming[0]);
        for (int c = 0; c < P8EST_CHILDREN; ++c) {
            const Cell& child = cell_of(*outgoing[c]);
            father.u += child.u / P8EST_CHILDREN;
            for (std::size_t f = 0; f < 6; ++f) {
                father.slope[f] += child.limited_slope(f / 2) / P8EST_CHILDREN;
            }
        }
    } else {
        const Cell& father = cell_of(*outgoing[0]);
        for (int c = 0; c < P8EST_CHILDREN; ++c) {
            Cell& child = cell_of(*incoming[c]);
            child.u = father.value(child.centre);
            for (std::size_t f = 0; f < 6; ++f) child.slope[f] = father.limited_slope(f / 2);
        }
    }
}

int may_coarsen(p8est_t*, p4est_topidx_t, p8est_quadrant_t* family[]) {
    return family[0]->level > coarsest &&
           std::all_of(family, family + P8EST_CHILDREN, [](const p8est_quadrant_t* q) {
               return cell_of(*q).jump() < largest_jump / 4;
           });
}

int must_refine(p8est_t*, p4est_topidx_t, p8est_quadrant_t* q) {
    return cell_of(*q).jump() > largest_jump;
}

// What p4est calls for faces.

/// The cells on one side of a face: one, or the four smaller ones where the face hangs.
struct Side {
    std::size_t face;  ///< of these cells: two for each axis, the lower one first
    std::size_t count;
    std::array<Cell*, 4> cells;

    Side(p8est_iter_face_info_t* info, int side) {
        const auto& s = *p8est_iter_fside_array_index_int(&info->sides, side);
        face = static_cast<std::size_t>(s.face);
        count = s.is_hanging ? 4 : 1;
        cells.fill(s.is_hanging ? nullptr : &cell_of(*s.is.full.quad));
        for (std::size_t i = 0; s.is_hanging && i < 4; ++i) {
            cells[i] = &cell_of(*s.is.hanging.quad[i]);
        }
    }
    double mean() const {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += cells[i]->u;
        return sum / static_cast<double>(count);
    }
};

bool at_wall(const p8est_iter_face_info_t& info) { return info.sides.elem_count == 1; }

/// The middle of four smaller cells lies straight across from that of the larger one.
void find_slope(p8est_iter_face_info_t* info, void*) {
    const Side a(info, 0);
    if (at_wall(*info)) {
        a.cells[0]->slope[a.face] = 0;
        return;
    }
    const Side b(info, 1);
    const std::size_t axis = a.face / 2;
    const double slope =
        (b.mean() - a.mean()) / (b.cells[0]->centre[axis] - a.cells[0]->centre[axis]);
    for (const Side* side : {&a, &b}) {
        for (std::size_t i = 0; i < side->count; ++i) side->cells[i]->slope[side->face] = slope;
    }
}

/// Moves u from one side to the other: the value upwind, at the place that reaches the middle of
/// the face in the middle of the step.
void exchange(p8est_iter_face_info_t* info, void* user_data) {
    if (at_wall(*info)) return;
    const double time_step = *static_cast<const double*>(user_data);
    const Side a(info, 0);
    const Side b(info, 1);
    const std::size_t axis = a.face / 2;
    const bool ascending = a.face % 2 == 1;
    for (std::size_t i = 0; i < std::max(a.count, b.count); ++i) {
        Cell& lower = *(ascending ? a : b).cells[i];
        Cell& upper = *(ascending ? b : a).cells[i];
        const bool lower_is_smaller = lower.size < upper.size;
        const Cell& smaller = lower_is_smaller ? lower : upper;
        Vector x = smaller.centre;
        x[axis] += (lower_is_smaller ? 0.5 : -0.5) * smaller.size;
        const double volume = time_step * flow(axis, x, smaller.size);
        const Vector v = velocity(x);
        for (std::size_t d = 0; d < 3; ++d) x[d] -= 0.5 * time_step * v[d];
        const double amount = volume * (volume > 0 ? lower : upper).value(x);
        lower.gain -= amount;
        upper.gain += amount;
    }
}

class Advection {
public:
    Advection() {
        for (int level = coarsest; level <= finest; ++level) {
            for_each_cell([](Cell& cell) { cell.u = exact(cell.centre, 0); });
            if (level < finest) adapt();
        }
    }

    void adapt() {
        p8est_t* f = forest_.get();
        p8est_iterate(f, nullptr, nullptr, nullptr, find_slope, nullptr, nullptr);
        p8est_coarsen_ext(f, 0, 0, may_coarsen, create, replace);
        p8est_refine_ext(f, 0, finest, must_refine, create, replace);
        p8est_balance_ext(f, P8EST_CONNECT_FULL, create, replace);
    }
    void step(double time_step) {
        p8est_t* f = forest_.get();
        p8est_iterate(f, nullptr, nullptr, nullptr, find_slope, nullptr, nullptr);
        p8est_iterate(f, nullptr, &time_step, nullptr, exchange, nullptr, nullptr);
        for_each_cell([](Cell& cell) {
            cell.u += cell.gain / cell.volume();
            cell.gain = 0;
        });
    }
    template <class Function>
    void for_each_cell(const Function& function) const {
        for (p4est_topidx_t t = 0; t < forest_->connectivity->num_trees; ++t) {
            sc_array_t& leaves = p8est_tree_array_index(forest_->trees, t)->quadrants;
            for (std::size_t i = 0; i < leaves.elem_count; ++i) {
                function(cell_of(*p8est_quadrant_array_index(&leaves, i)));
            }
        }
    }
    const p8est_t* forest() const { return forest_.get(); }

private:
    template <auto destroy>
    struct Destroy {
        template <class T>
        void operator()(T* t) const {
            destroy(t);
        }
    };
    std::unique_ptr<p8est_connectivity_t, Destroy<p8est_connectivity_destroy>> trees_{
        p8est_connectivity_new_brick(2, 2, 1, 0, 0, 0)};
    std::unique_ptr<p8est_t, Destroy<p8est_destroy>> forest_{p8est_new_ext(
        sc_MPI_COMM_WORLD, trees_.get(), 0, coarsest, 1, sizeof(Cell), create, nullptr)};
};

struct Totals {
    double mass = 0;
    double error = 0;  ///< L1
    double least = 1;
    double greatest = 0;
    double smallest = 1;  ///< sizes of cells
    double largest = 0;
};

Totals totals(const Advection& solver, double time) {
    Totals t;
    solver.for_each_cell([&](const Cell& cell) {
        t.mass += cell.u * cell.volume();
        t.error += std::abs(cell.u - exact(cell.centre, time)) * cell.volume();
        t.least = std::min(t.least, cell.u);
        t.greatest = std::max(t.greatest, cell.u);
        t.smallest = std::min(t.smallest, cell.size);
        t.largest = std::max(t.largest, cell.size);
    });
    return t;
}

/// The surfaces of a run, and the list of them that ParaView plays. Every file appears complete, by
/// rename.
class Film {
public:
    explicit Film(std::string folder) : folder_{std::move(folder)} {}

    template <class Surface>
    void add(double time, const Surface& surface) {
        char name[32];
        std::snprintf(name, sizeof name, "surface-%04d.vtp", count_++);
        const vtkNew<vtkXMLPolyDataWriter> writer;
        writer->SetInputData(nestgrid::make_poly_data(surface));
        writer->SetFileName((folder_ + "/" + name + ".part").c_str());
        if (writer->Write() != 1) throw nestgrid::IoError(std::string(name) + " was not written");
        publish(name);
        entries_ +=
            "    <DataSet timestep=\"" + std::to_string(time) + "\" file=\"" + name + "\"/>\n";
        std::ofstream list(folder_ + "/surface.pvd.part");
        list << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
             << "  <Collection>\n"
             << entries_ << "  </Collection>\n</VTKFile>\n";
        list.close();
        if (!list) throw nestgrid::IoError("surface.pvd was not written");
        publish("surface.pvd");
    }

private:
    void publish(const std::string& name) const {
        const std::string path = folder_ + "/" + name;
        std::filesystem::rename(path + ".part", path);
    }
    std::string folder_;
    std::string entries_;
    int count_ = 0;
};

int run(int steps, const std::string& folder) {
    using Clock = std::chrono::steady_clock;
    const auto milliseconds = [](Clock::duration d) {
        return std::chrono::duration<double, std::milli>(d).count();
    };
    Advection solver;
    Film film(folder);
    Totals now = totals(solver, 0);
    const double mass = now.mass;
    Clock::duration solving{};
    std::printf(
        "step  time leaves  level    mass     drift  L1 error    min    max triangles open "
        " area   volume  ms: surface solver\n");
    for (int step = 0; step <= steps; ++step) {
        if (step > 0) {
            const auto start = Clock::now();
            if (step % steps_per_adaptation == 0) solver.adapt();
            solver.step(1.0 / steps_per_rotation);
            solving += Clock::now() - start;
        }
        if (step % steps_per_surface != 0 && step != steps) continue;

        // All there is to it: the grid, where a leaf keeps its value, the surface.
        const auto start = Clock::now();
        const nestgrid::P4estGrid grid(solver.forest());
        const nestgrid::CellAverages field(
            grid, [&](const auto& leaf) { return cell_of(grid.quadrant(leaf)).u; });
        const auto result = nestgrid::isosurface(grid, field, 0.5, {.threshold = 0.002});
        const auto extracting = Clock::now() - start;

        const double time = static_cast<double>(step) / steps_per_rotation;
        now = totals(solver, time);
        const double drift = now.mass / mass - 1;
        const auto report = nestgrid::surface_report(result.surface);
        std::printf(
            "%4d %5.3f %6zu %3d-%d %9.7f %9.1e %9.4f %6.3f %6.3f %9zu %4zu %6.4f %8.6f "
            "%11.1f %6.0f\n",
            step, time, grid.leaf_count(), -std::ilogb(now.largest), -std::ilogb(now.smallest),
            now.mass, drift, now.error / mass, now.least, now.greatest, report.triangles,
            report.open_edges, report.area, report.volume, milliseconds(extracting),
            milliseconds(solving));
        solving = {};
        if (!(std::abs(drift) < 1e-12) || report.open_edges > 0) return 1;
        if (!folder.empty()) film.add(time, result.surface);
    }
    if (steps % steps_per_rotation == 0) {
        std::printf("After %d rotations u differs from its beginning by %.1f %% of the mass.\n",
                    steps / steps_per_rotation, 100 * now.error / mass);
    }
    return 0;
}

/// Says what is wrong with the command line, or with the number of processes; nothing if all is
/// well.
std::string complaint(int argc, char** argv, int& steps) {
    int processes = 0;
    sc_MPI_Comm_size(sc_MPI_COMM_WORLD, &processes);
    if (processes > 1) return "this example runs in one process";
    if (argc > 3) return "usage: p4est_advection [steps] [folder for surfaces]";
    if (argc > 1) {
        const char* end = argv[1] + std::strlen(argv[1]);
        const auto [behind, error] = std::from_chars(argv[1], end, steps);
        if (error != std::errc() || behind != end || steps < 1 || steps > 1000000) {
            return std::string("the number of steps is not one from 1 to 1000000: ") + argv[1];
        }
    }
    if (argc > 2 && !std::filesystem::is_directory(argv[2])) {
        return std::string("there is no folder ") + argv[2];
    }
    return "";
}

}  // namespace

int main(int argc, char** argv) {
    sc_MPI_Init(&argc, &argv);
    sc_init(sc_MPI_COMM_WORLD, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    int steps = steps_per_rotation;
    int status = 1;
    try {
        const std::string wrong = complaint(argc, argv, steps);
        if (wrong.empty()) {
            status = run(steps, argc > 2 ? argv[2] : "");
        } else if (sc_is_root()) {
            std::fprintf(stderr, "p4est_advection: %s\n", wrong.c_str());
        }
    } catch (const std::exception& e) {
        std::fprintf(stderr, "p4est_advection: %s\n", e.what());
    }
    sc_finalize();
    sc_MPI_Finalize();
    return status;
}
