// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Surfaces of deal.II's FE_Q(2), (4) and (6) on a locally refined mesh, within four tolerances
// each, beside those that VTK draws of DataOut's subdivided cells. The error of both is measured,
// as the greatest |U - isovalue| at six points of triangles. One process, one thread, processor
// time; bytes of the heap. Once per solution, two threads are timed beside one by the clock. One
// "name value" line per figure; --quick takes a small mesh, --curved draws bent cells beside
// straight ones and nothing else.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <sstream>
#include <string>

#include <deal.II/base/function.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/fe/mapping_q_cache.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools.h>
#include <vtkContourFilter.h>
#include <vtkFeatureEdges.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <nestgrid/adapters/dealii.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "counted_heap.hpp"
#include "thread_executor.hpp"

namespace {

using namespace nestgrid;
using DoubleVector = dealii::Vector<double>;

constexpr double isovalue = 0.3;

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
void print(const std::string& name, double value) {
    std::printf("%s %.6g\n", name.c_str(), value);
    std::fflush(stdout);
}

class Waves final : public dealii::Function<3> {
public:
    double value(const dealii::Point<3>& x, unsigned) const override {
        return std::sin(5 * x[0]) * std::cos(4 * x[1]) + std::sin(4 * x[1]) * std::cos(5 * x[2]) +
               std::sin(5 * x[2]) * std::cos(4 * x[0]);
    }
};

/// Reads the leaves that the level set passes through, as front ends do.
VirtualRefinement looking_at_level_set(const HighOrder& data, double tolerance) {
    return {data, {.tolerance = tolerance, .values = {{{isovalue, isovalue}}}}};
}

/// Makes the next drawing read polynomials anew.
void forget(const HighOrder& data) {
    const double above = std::numeric_limits<double>::max();
    (void)VirtualRefinement(data, {.tolerance = 1, .values = {{{above, above}}}});
}

/// An interpolated function on cells that are smaller around a sphere.
class Problem {
public:
    Problem(unsigned degree, unsigned global) : fe_(degree) {
        dealii::GridGenerator::hyper_cube(triangulation, -1, 1);
        triangulation.refine_global(global);
        for (int step = 1; step <= 2; ++step) {
            for (const auto& cell : triangulation.active_cell_iterators()) {
                if (std::abs(cell->center().norm() - 0.7) < 0.12 / step) cell->set_refine_flag();
            }
            triangulation.execute_coarsening_and_refinement();
        }
        dofs.reinit(triangulation);
        dofs.distribute_dofs(fe_);
        values.reinit(dofs.n_dofs());
        dealii::VectorTools::interpolate(dealii::MappingQ1<3>(), dofs, Waves(), values);
        dealii::AffineConstraints<double> constraints;
        dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
        constraints.close();
        constraints.distribute(values);
    }

    /// The data at a point, by descent and shape functions.
    double operator()(const Point& x) const {
        auto cell = triangulation.begin(0);
        while (cell->has_children()) {
            const auto middle = cell->center();
            unsigned child = 0;
            for (unsigned d = 0; d < 3; ++d) child |= unsigned{x[d] >= middle[d]} << d;
            cell = cell->child(child);
        }
        const dealii::DoFHandler<3>::active_cell_iterator at(&triangulation, cell->level(),
                                                             cell->index(), &dofs);
        DoubleVector local(fe_.dofs_per_cell);
        at->get_dof_values(values, local);
        dealii::Point<3> reference;
        for (unsigned d = 0; d < 3; ++d) {
            const double low = cell->vertex(0)[d];
            reference[d] = std::clamp((x[d] - low) / (cell->vertex(7)[d] - low), 0.0, 1.0);
        }
        double sum = 0;
        for (unsigned i = 0; i < local.size(); ++i) sum += local[i] * fe_.shape_value(i, reference);
        return sum;
    }

    dealii::Triangulation<3> triangulation;
    dealii::DoFHandler<3> dofs;
    DoubleVector values;

private:
    dealii::FE_Q<3> fe_;
};

/// The greatest |U - isovalue| on about 5,000 of some triangles.
/// \param corner gives corner k of triangle t
template <class Corner>
double measured(const Problem& problem, std::size_t count, const Corner& corner) {
    double greatest = 0;
    for (std::size_t t = 0; t < count; t += std::max<std::size_t>(1, count / 5000)) {
        for (int a = 0; a <= 2; ++a) {
            for (int b = 0; a + b <= 2; ++b) {
                const Point x = a / 2.0 * corner(t, 0) + b / 2.0 * corner(t, 1) +
                                (1 - (a + b) / 2.0) * corner(t, 2);
                greatest = std::max(greatest, std::abs(problem(x) - isovalue));
            }
        }
    }
    return greatest;
}

struct Drawing {
    double triangles;
    double error;
    double through_file;  // seconds
    double in_memory;
    double contour_alone;
    double grid_bytes;  // of the cells that VTK contours
};

/// The cells of DataOut, divided n times along each direction, and VTK's contour of them.
Drawing subdivided(const Problem& problem, unsigned n, const std::string& name) {
    const double begin = seconds();
    dealii::DataOut<3> out;
    out.attach_dof_handler(problem.dofs);
    out.add_data_vector(problem.values, "u");
    out.build_patches(n);
    const double built = seconds();
    dealii::DataOutBase::VtkFlags flags;
    flags.compression_level = dealii::DataOutBase::VtkFlags::no_compression;
    out.set_flags(flags);
    std::stringstream file;
    out.write_vtu(file);
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->ReadFromInputStringOn();
    reader->SetInputString(file.str());
    reader->Update();
    reader->GetOutput()->GetPointData()->SetActiveScalars("u");
    const double read = seconds();
    const double grid_bytes =
        1024.0 * static_cast<double>(reader->GetOutput()->GetActualMemorySize());
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(reader->GetOutput());
    contour->SetValue(0, isovalue);
    contour->Update();
    const double drawn = seconds();
    vtkPolyData* const surface = contour->GetOutput();
    vtkNew<vtkFeatureEdges> edges;
    edges->SetInputData(surface);
    edges->FeatureEdgesOff();
    edges->NonManifoldEdgesOff();
    edges->ManifoldEdgesOff();
    edges->Update();
    const auto count = static_cast<std::size_t>(surface->GetNumberOfCells());
    const double error = measured(problem, count, [&](std::size_t t, int k) {
        Point x{};
        surface->GetPoint(surface->GetCell(static_cast<vtkIdType>(t))->GetPointId(k), x.data());
        return x;
    });
    print(name + "_triangles", static_cast<double>(count));
    print(name + "_measured", error);
    print(name + "_open_edges_with_boundary",
          static_cast<double>(edges->GetOutput()->GetNumberOfCells()));
    const Drawing made{static_cast<double>(count),   error,        drawn - begin,
                       built - begin + drawn - read, drawn - read, grid_bytes};
    print(name + "_seconds_through_file", made.through_file);
    print(name + "_seconds_in_memory", made.in_memory);
    print(name + "_seconds_contour_alone", made.contour_alone);
    print(name + "_grid_bytes", made.grid_bytes);
    return made;
}

/// What uniform subdivision needs for an error, between and beyond its drawings, of which the error
/// is a power.
double needed_at(const std::vector<Drawing>& drawings, double error, double Drawing::*what) {
    std::size_t i = 1;
    while (i + 1 < drawings.size() && drawings[i].error > error) ++i;
    const Drawing& a = drawings[i - 1];
    const Drawing& b = drawings[i];
    const double t = std::log(error / a.error) / std::log(b.error / a.error);
    return a.*what * std::pow(b.*what / a.*what, t);
}

/// How many times as fast two threads are once per solution, by the clock.
double speed_of_two(const DealiiGrid<3>& grid, const DealiiField<3, DoubleVector>& field) {
    std::array<double, 2> took{};
    for (const std::size_t threads : {1, 2}) {
        const nestgrid_test::ThreadExecutor executor(threads);
        const auto begin = std::chrono::steady_clock::now();
        const HighOrder data(grid, field, executor);
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
        took[threads - 1] = passed.count();
    }
    return took[0] / took[1];
}

double run(unsigned degree, bool quick) {
    const Problem problem(degree, quick ? 2 : degree > 4 ? 3 : 4);
    const std::string name = "q" + std::to_string(degree);
    print(name + "_cells", problem.triangulation.n_active_cells());
    std::vector<Drawing> uniform;
    for (const unsigned n : {1U, 2U, 4U}) {
        if (quick && n > 2) break;
        uniform.push_back(subdivided(problem, n, name + "_uniform_" + std::to_string(n)));
    }
    const DealiiGrid<3> grid(problem.triangulation);
    const DealiiField<3, DoubleVector> field(grid, problem.dofs, problem.values);
    const double begin = seconds();
    const HighOrder data(grid, field);
    const double once = seconds() - begin;
    print(name + "_once_seconds", once);
    print(name + "_once_bytes_a_cell",
          static_cast<double>(data.memory_bytes()) / problem.triangulation.n_active_cells());
    print(name + "_once_two_threads", speed_of_two(grid, field));
    double ratios = 0;
    int count = 0;
    for (const double tolerance : {0.1, 0.03, 0.01, 0.003}) {
        const std::string at = name + "_tolerance_" + std::to_string(++count);
        const auto draw = [&](const VirtualRefinement& fine) {
            return isosurface<3>(fine, isovalue, under(fine.criterion(), fine.bounds()));
        };
        // Polynomials and records, which are kept, the walk, and the surface.
        forget(data);
        const std::size_t before = data.memory_bytes();
        const std::size_t bytes =
            peak_heap_bytes([&] { (void)draw(looking_at_level_set(data, tolerance)); });
        const std::size_t kept = data.memory_bytes() - before;
        const std::size_t next_bytes =
            peak_heap_bytes([&] { (void)draw(looking_at_level_set(data, tolerance)); });
        forget(data);
        const double start = seconds();
        const VirtualRefinement fine = looking_at_level_set(data, tolerance);
        const auto result = draw(fine);
        const double first = seconds() - start;
        print(at + "_seconds", first);
        const double again = seconds();
        (void)draw(fine);
        const double next = seconds() - again;
        print(at + "_next_seconds", next);
        const auto& surface = result.surface;
        const double error = measured(problem, surface.simplices.size(), [&](std::size_t t, int k) {
            return surface.vertices[surface.simplices[t][static_cast<std::size_t>(k)]];
        });
        const auto triangles = static_cast<double>(surface.simplices.size());
        print(at + "_triangles", triangles);
        print(at + "_bound", result.error_bound);
        print(at + "_measured", error);
        print(at + "_open_edges", static_cast<double>(surface_report(surface).open_edges));
        const double ratio = triangles / needed_at(uniform, error, &Drawing::triangles);
        print(at + "_file_of_first",
              needed_at(uniform, error, &Drawing::through_file) / (once + first));
        print(at + "_memory_of_first",
              needed_at(uniform, error, &Drawing::in_memory) / (once + first));
        const double grid_bytes = needed_at(uniform, error, &Drawing::grid_bytes);
        print(at + "_bytes", static_cast<double>(bytes));
        print(at + "_kept_bytes", static_cast<double>(kept));
        print(at + "_next_bytes", static_cast<double>(next_bytes));
        print(at + "_bytes_of_grid", static_cast<double>(bytes) / grid_bytes);
        print(at + "_kept_bytes_of_grid", static_cast<double>(kept) / grid_bytes);
        print(at + "_contour_of_next", needed_at(uniform, error, &Drawing::contour_alone) / next);
        print(at + "_of_uniform", ratio);
        ratios += std::log(ratio);
        if (quick && tolerance < 0.05) break;
    }
    return std::exp(ratios / count);
}

/// The same data in cells that are bent by a polynomial of degree 2, beside the straight ones:
/// once, and at the same tolerances of the data.
void run_curved(unsigned degree, bool quick) {
    const Problem problem(degree, quick ? 2 : 3);
    const std::string name = "q" + std::to_string(degree);
    dealii::MappingQCache<3> bent(2);
    bent.initialize(
        dealii::MappingQ1<3>(), problem.triangulation,
        [](const auto&, const dealii::Point<3>& x) {
            return dealii::Point<3>(0.1 * x[1] * x[2], -0.1 * x[0] * x[2], 0.1 * x[0] * x[1]);
        },
        true);
    std::vector<double> straight;
    for (const dealii::Mapping<3>* const mapping :
         {static_cast<const dealii::Mapping<3>*>(nullptr),
          static_cast<const dealii::Mapping<3>*>(&bent)}) {
        const std::string which = name + (mapping == nullptr ? "_straight" : "_curved");
        const DealiiGrid<3> grid(problem.triangulation, mapping);
        const DealiiField<3, DoubleVector> field(grid, problem.dofs, problem.values);
        std::vector<double> costs;
        const auto took = [&](const std::string& what, double begin, double of) {
            costs.push_back((seconds() - begin) / of);
            print(which + what, costs.back());
        };
        const double begin = seconds();
        const HighOrder data(grid, field);
        took("_once_seconds", begin, 1);
        for (const double tolerance : {0.03, 0.003}) {
            const double start = seconds();
            const VirtualRefinement fine = looking_at_level_set(data, tolerance);
            const auto result =
                isosurface<3>(fine, isovalue, under(fine.criterion(), fine.bounds()));
            const auto triangles = static_cast<double>(result.surface.simplices.size());
            const std::string at = "_tolerance_" + std::to_string(costs.size());
            took(at + "_seconds_a_million_triangles", start, triangles / 1e6);
            print(which + at + "_triangles", triangles);
            print(which + at + "_position_bound", result.position_bound);
        }
        if (mapping == nullptr) straight = costs;
        for (std::size_t i = 0; mapping != nullptr && i < costs.size(); ++i) {
            print(which + "_of_straight_" + std::to_string(i), costs[i] / straight[i]);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const bool curved = argc > 1 && std::strcmp(argv[1], "--curved") == 0;
    for (const unsigned degree : {2U, 4U, 6U}) {
        run_curved(degree, quick);
        if (curved) continue;
        const double mean = run(degree, quick);
        print("q" + std::to_string(degree) + "_mean_of_uniform", mean);
    }
}
