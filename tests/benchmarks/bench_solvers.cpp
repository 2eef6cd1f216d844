// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An isosurface of a solution on an adaptive triangulation of deal.II: straight from the solver's
// vector, and as it is done otherwise, by dealii::DataOut and VTK's contour, in memory or through a
// file, each with one thread and with two. Each contestant runs in a process of its own on the same
// solution, so that its peak of memory and its threads are its own. Then, where they are there,
// p4est and Dune's UGGrid: what an element that is visited costs in each. Prints one "name value"
// line per figure; --quick takes a small grid.
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <deal.II/base/multithread_info.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools.h>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkContour3DLinearGrid.h>
#include <vtkContourFilter.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/adapters/tbb.hpp>

#include "open_edges.hpp"
#include "solver_runs.hpp"

namespace {

using Vector = dealii::Vector<double>;
constexpr double isovalue = 0;

double peak_bytes() {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word) {
        double kilobytes = 0;
        if (word == "VmHWM:" && status >> kilobytes) return 1024 * kilobytes;
    }
    return 0;
}

struct Problem {
    dealii::Triangulation<3> triangulation;
    dealii::DoFHandler<3> dofs{triangulation};
    Vector values;

    explicit Problem(std::size_t cells) {
        dealii::GridGenerator::hyper_cube(triangulation);
        triangulation.refine_global(3);
        const auto f = [](const dealii::Point<3>& x) {
            return 0.31 - x.distance({0.52, 0.49, 0.5}) + 0.04 * std::sin(20 * x[0]) * x[1];
        };
        while (triangulation.n_active_cells() < cells) {
            for (const auto& c : triangulation.active_cell_iterators()) {
                if (std::abs(f(c->center())) < 0.6 * c->diameter()) c->set_refine_flag();
            }
            triangulation.execute_coarsening_and_refinement();
        }
        dofs.distribute_dofs(dealii::FE_Q<3>(1));
        values.reinit(dofs.n_dofs());
        dealii::VectorTools::interpolate(dofs, dealii::ScalarFunctionFromFunctionObject<3>(f),
                                         values);
        dealii::AffineConstraints<double> constraints;
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
        constraints.distribute(values);
    }
};

Run ours(const Problem& p, double threshold, int threads, bool copied) {
    Run run;
    const auto start = Clock::now();
    const nestgrid::DealiiGrid<3> grid(p.triangulation);
    const nestgrid::DealiiField field(grid, p.dofs, p.values);
    const auto time = [&](const nestgrid::Executor& executor) {
        copied ? time_copied(grid, field, threshold, start, run, executor)
               : time_isosurfaces(grid, field, threshold, start, run, executor);
    };
    threads > 1 ? time(nestgrid::TbbExecutor(threads)) : time(nestgrid::SequentialExecutor{});
    return run;
}

/// DataOut keeps its patches to itself and its writers.
class Patches : public dealii::DataOut<3> {
public:
    using dealii::DataOut<3>::get_patches;
};

void build(Patches& out, const Problem& p) {
    out.attach_dof_handler(p.dofs);
    out.add_data_vector(p.values, "u");
    out.build_patches();
}

/// The leaves as an unstructured grid, as they come from DataOut: every cell with corners of its
/// own.
vtkNew<vtkUnstructuredGrid> leaves_of(const Problem& p, int type) {
    Patches out;
    build(out, p);
    const vtkNew<vtkPoints> points;
    points->SetDataType(type);
    const vtkNew<vtkDoubleArray> u;
    const vtkNew<vtkCellArray> cells;
    u->SetName("u");
    for (const auto& patch : out.get_patches()) {
        std::array<vtkIdType, 8> corner{};
        // VTK goes around the lower and upper faces.
        const std::array<unsigned, 8> order{0, 1, 3, 2, 4, 5, 7, 6};
        for (unsigned k = 0; k < 8; ++k) {
            const auto& x = patch.vertices[order[k]];
            corner[k] = points->InsertNextPoint(x[0], x[1], x[2]);
            u->InsertNextValue(patch.data(0, order[k]));
        }
        cells->InsertNextCell(8, corner.data());
    }
    vtkNew<vtkUnstructuredGrid> leaves;
    leaves->SetPoints(points);
    leaves->SetCells(VTK_HEXAHEDRON, cells);
    leaves->GetPointData()->SetScalars(u);
    return leaves;
}

/// The contour of leaves: by VTK's fast filter for linear cells.
template <class Input>
void contour(Input&& connect, int threads, Run& run, Clock::time_point start) {
    const vtkNew<vtkContour3DLinearGrid> filter;
    connect(filter.Get());
    filter->SetMergePoints(true);
    setenv("VTK_SMP_MAX_THREADS", std::to_string(threads).c_str(), 1);
    filter->SetSequentialProcessing(threads == 1);
    filter->SetValue(0, isovalue);
    filter->Update();
    run.first = seconds_since(start);
    run.triangles = static_cast<double>(
        vtkPolyData::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfPolys());
    const auto again = Clock::now();
    filter->SetValue(0, isovalue + 1e-3);
    filter->Update();
    run.next = seconds_since(again);
}

Run in_memory(const Problem& p, int threads) {
    Run run;
    const auto start = Clock::now();
    const vtkNew<vtkUnstructuredGrid> leaves = leaves_of(p, VTK_FLOAT);
    contour([&](vtkContour3DLinearGrid* filter) { filter->SetInputData(leaves); }, threads, run,
            start);
    return run;
}

Run through_file(const Problem& p, int threads) {
    Run run;
    const auto path = std::filesystem::temp_directory_path() /
                      ("bench_solvers_" + std::to_string(getpid()) + ".vtu");
    const auto start = Clock::now();
    {
        Patches out;
        build(out, p);
        std::ofstream file(path);
        out.write_vtu(file);
    }
    const vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    reader->GetOutput()->GetPointData()->SetActiveScalars("u");
    contour([&](vtkContour3DLinearGrid* filter) { filter->SetInputData(reader->GetOutput()); },
            threads, run, start);
    std::filesystem::remove(path);
    return run;
}

void print(const std::string& name, double value) { std::printf("%s %g\n", name.c_str(), value); }

/// Cracks where a level set crosses changes of size.
void print_cracks(const Problem& p, double value) {
    using nestgrid::count_edges;
    using nestgrid::Point;
    const nestgrid::DealiiGrid<3> grid(p.triangulation);
    const auto surface =
        nestgrid::isosurface(grid, nestgrid::DealiiField(grid, p.dofs, p.values), value).surface;
    nestgrid::Triangles triangles;
    for (const auto& t : surface.simplices) triangles.push_back({t[0], t[1], t[2]});
    const auto ours = count_edges(surface.vertices, triangles);

    const vtkNew<vtkContourFilter> filter;
    filter->SetInputData(leaves_of(p, VTK_DOUBLE));
    filter->SetValue(0, value);
    filter->Update();
    std::vector<Point> points;
    triangles.clear();
    for (vtkIdType v = 0; v < filter->GetOutput()->GetNumberOfPoints(); ++v) {
        points.emplace_back();
        filter->GetOutput()->GetPoint(v, points.back().data());
    }
    vtkIdType n = 0;
    const vtkIdType* corner = nullptr;
    for (vtkIdType t = 0; t < filter->GetOutput()->GetNumberOfCells(); ++t) {
        filter->GetOutput()->GetCellPoints(t, n, corner);
        if (n != 3) continue;
        triangles.push_back(
            {std::size_t(corner[0]), std::size_t(corner[1]), std::size_t(corner[2])});
    }
    nestgrid::merge(points, triangles);
    const auto vtk = count_edges(points, triangles);

    std::vector<dealii::Point<3>> vertices;
    std::vector<dealii::CellData<2>> cells;
    const dealii::MappingQ<3> mapping(1);
    dealii::GridTools::MarchingCubeAlgorithm<3, Vector>(mapping, p.dofs.get_fe())
        .process(p.dofs, p.values, value, vertices, cells);
    points.clear();
    triangles.clear();
    for (const auto& x : vertices) points.push_back({x[0], x[1], x[2]});
    for (const auto& c : cells) triangles.push_back({c.vertices[0], c.vertices[1], c.vertices[2]});
    nestgrid::merge(points, triangles);
    const auto dealii = count_edges(points, triangles);

    print("cracks_ours_triangles", static_cast<double>(ours.triangles));
    print("cracks_ours_open_edges", static_cast<double>(ours.open));
    print("cracks_vtk_triangles", static_cast<double>(vtk.triangles));
    print("cracks_vtk_open_edges", static_cast<double>(vtk.open));
    print("cracks_marching_cubes_triangles", static_cast<double>(dealii.triangles));
    print("cracks_marching_cubes_open_edges", static_cast<double>(dealii.open));
}

void print_run(const std::string& name, const Run& run) {
    print(name + "_seconds_first", run.first);
    print(name + "_seconds_next", run.next);
    print(name + "_extra_megabytes", run.bytes / 1e6);
    print(name + "_triangles", run.triangles);
}

/// \param run of another grid, at another level set
[[maybe_unused]] void print_solver(const std::string& name, const Run& run) {
    print(name + "_cells", run.leaves);
    print(name + "_seconds_first", run.first);
    print(name + "_seconds_next", run.next);
    print(name + "_triangles", run.triangles);
    print(name + "_ns_per_visited", 1e9 * run.next / run.visited);
    print(name + "_copied_ns_per_visited", 1e9 * run.copied_next / run.visited);
}

constexpr std::array contestants{"ours",
                                 "ours_threshold_0.005",
                                 "copied",
                                 "copied_threshold_0.005",
                                 "data_out_in_memory",
                                 "data_out_file"};

Run run_contestant(const std::string& name, int threads, bool quick) {
#ifdef NESTGRID_WITH_P4EST
    if (name == "p4est") return run_p4est(quick ? 5 : 8);
#endif
#ifdef NESTGRID_WITH_DUNE
    if (name == "dune_ug") return run_dune_ug(quick ? 2 : 5);
#endif
    dealii::MultithreadInfo::set_thread_limit(static_cast<unsigned>(threads));
    const Problem p(quick ? 20000 : 1000000);
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts here
    const double before = peak_bytes();
    Run run = name == contestants[0]   ? ours(p, 0, threads, false)
              : name == contestants[1] ? ours(p, 0.005, threads, false)
              : name == contestants[2] ? ours(p, 0, threads, true)
              : name == contestants[3] ? ours(p, 0.005, threads, true)
              : name == contestants[4] ? in_memory(p, threads)
                                       : through_file(p, threads);
    run.bytes = peak_bytes() - before;
    return run;
}

/// Runs a contestant in a process of its own, which is this program again.
Run alone(const std::string& name, int threads, bool quick) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child == 0) {
        const std::string to = std::to_string(ends[1]);
        const std::string count = std::to_string(threads);
        execl("/proc/self/exe", "bench_solvers", "--contestant", name.c_str(), count.c_str(),
              quick ? "quick" : "full", to.c_str(), nullptr);
        _exit(1);
    }
    close(ends[1]);
    Run run;
    const bool told = read(ends[0], &run, sizeof run) == sizeof run;
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (!told || status != 0) throw std::runtime_error("contestant " + name + " failed");
    return run;
}

/// \param with what stands behind the names: the threads, where there are several
void print_contest(const std::string& with, int threads, bool quick) {
    std::array<Run, contestants.size()> run;
    for (std::size_t i = 0; i < run.size(); ++i) {
        if (threads > 1 && i == 5) continue;  // writing the file takes one
        run[i] = alone(contestants[i], threads, quick);
        print_run(std::string("dealii_") + contestants[i] + with, run[i]);
    }
    const auto& [here, coarse, copied, copied_coarse, memory, file] = run;
    print("dealii_memory_ratio" + with, memory.bytes / here.bytes);
    print("dealii_time_ratio_first" + with, memory.first / here.first);
    print("dealii_time_ratio_next" + with, memory.next / here.next);
    print("dealii_time_ratio_first_threshold_0.005" + with, memory.first / coarse.first);
    print("dealii_time_ratio_next_threshold_0.005" + with, memory.next / coarse.next);
    print("dealii_time_ratio_next_copied" + with, copied.next / here.next);
    print("dealii_time_ratio_next_copied_threshold_0.005" + with, copied_coarse.next / coarse.next);
    if (threads > 1) return;
    print("dealii_file_time_ratio_first", file.first / here.first);
    print("dealii_ns_per_visited", 1e9 * here.next / here.visited);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc == 6 && std::strcmp(argv[1], "--contestant") == 0) {
            const Run run =
                run_contestant(argv[2], std::atoi(argv[3]), std::strcmp(argv[4], "quick") == 0);
            return write(std::atoi(argv[5]), &run, sizeof run) == sizeof run ? 0 : 1;
        }
        const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
        print_contest("", 1, quick);
        print_contest("_two_threads", 2, quick);
        const Problem problem(quick ? 20000 : 1000000);
        print("dealii_cells", problem.triangulation.n_active_cells());
        print("dealii_levels", problem.triangulation.n_levels());
        print_cracks(problem, 0.1);
#ifdef NESTGRID_WITH_P4EST
        print_solver("p4est", alone("p4est", 1, quick));
#endif
#ifdef NESTGRID_WITH_DUNE
        print_solver("dune_ug", alone("dune_ug", 1, quick));
#endif
    } catch (const std::exception& error) {
        std::fprintf(stderr, "bench_solvers: %s\n", error.what());
        return 1;
    }
    return 0;
}
