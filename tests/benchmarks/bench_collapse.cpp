// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Collapses that keep an error beside vtkQuadricDecimation of VTK's full contour, points merged, in
// processor time of one thread: to as many triangles, and to the triangles with which its greatest
// distance is no more than ours. Distances are measured both ways, each surface to the full one of
// its own data, linear on tetrahedra here and VTK's cells there. One "name value" line per figure.
// --quick takes 33^3 samples instead of 65^3, --large 129^3.
#include <cstdlib>
#include <cstring>
#include <random>

#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkFlyingEdges3D.h>
#include <vtkGenericCell.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>
#include <vtkStaticCellLocator.h>

#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>

#include "vtk_samples.hpp"

namespace {

using nestgrid::Point;
using nestgrid::operator+;
using nestgrid::operator-;
using nestgrid::operator*;

struct Data {
    std::string name;
    std::vector<float> samples;
    double isovalue;
    double error;
};

template <class Function>
std::vector<float> sample(int n, const Function& f) {
    std::vector<float> values;
    for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const double h = 2.0 / (n - 1);
                values.push_back(static_cast<float>(f(h * x - 1, h * y - 1, h * z - 1)));
            }
        }
    }
    return values;
}

/// Densities of organs, each edge blurred over about a sample, and noise of 20.
std::vector<float> tomography(int n) {
    std::mt19937 random(1);
    const double blur = 2.4 / n;
    const auto inside = [blur](double distance) { return 1 / (1 + std::exp(distance / blur)); };
    return sample(n, [&](double x, double y, double z) {
        double u = -1000;
        const auto set = [&](double density, double distance) {
            u += (density - u) * inside(distance);
        };
        const auto ellipsoid = [&](double a, double b, double c) {
            return 0.75 * (std::sqrt(x * x / (a * a) + y * y / (b * b) + z * z / (c * c)) - 1);
        };
        set(40, ellipsoid(0.85, 0.7, 0.9));
        set(900, std::max(ellipsoid(0.8, 0.65, 0.85), -ellipsoid(0.72, 0.57, 0.77)));
        set(700,
            std::hypot(std::hypot(x, y) - 0.35, z - 0.25 * std::sin(3 * std::atan2(y, x))) - 0.09);
        set(800, std::max({std::abs(x) - 0.3, std::abs(y + 0.3) - 0.04, std::abs(z + 0.3) - 0.25}));
        double noise = 0;
        for (int i = 0; i < 12; ++i) noise += static_cast<double>(random()) / 4294967296.0 - 0.5;
        return std::round(u + 20 * noise);
    });
}

std::vector<Data> all_data(int n) {
    std::vector<Data> data;
    data.push_back({"ball",
                    sample(n,
                           [](double x, double y, double z) {
                               const double r = std::hypot(x - 0.05, y + 0.03, z - 0.02);
                               return 1 - r / 0.6 +
                                      0.08 * std::sin(5 * x) * std::cos(4 * y + 1) *
                                          std::sin(3 * z + 2);
                           }),
                    0, 0.03});
    data.push_back({"gyroid",
                    sample(n,
                           [](double x, double y, double z) {
                               const double w = 2.5 * 3.14159265358979;
                               return std::sin(w * x) * std::cos(w * y) +
                                      std::sin(w * y) * std::cos(w * z) +
                                      std::sin(w * z) * std::cos(w * x);
                           }),
                    0, 0.12});
    data.push_back({"tomography", tomography(n), 400, 80});
    return data;
}

vtkNew<vtkPolyData> to_vtk(const nestgrid::Surface<3>& surface) {
    vtkNew<vtkPoints> points;
    for (const Point& x : surface.vertices) points->InsertNextPoint(x.data());
    vtkNew<vtkCellArray> cells;
    for (const auto& t : surface.simplices) {
        const std::array<vtkIdType, 3> ids{t[0], t[1], t[2]};
        cells->InsertNextCell(3, ids.data());
    }
    vtkNew<vtkPolyData> result;
    result->SetPoints(points);
    result->SetPolys(cells);
    return result;
}

/// The greatest distance of corners, middles of sides and centres of triangles from a surface.
double one_sided_distance(vtkPolyData* from, vtkPolyData* to) {
    vtkNew<vtkStaticCellLocator> locator;
    locator->SetDataSet(to);
    locator->BuildLocator();
    vtkNew<vtkGenericCell> cell;
    double greatest = 0;
    for (vtkIdType i = 0; i < from->GetNumberOfCells(); ++i) {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        from->GetCellPoints(i, count, ids);
        if (count != 3) continue;  // corners that were merged
        std::array<Point, 3> x;
        for (std::size_t k = 0; k < 3; ++k) from->GetPoint(ids[k], x[k].data());
        for (const Point& p : {x[0], x[1], x[2], 0.5 * (x[0] + x[1]), 0.5 * (x[1] + x[2]),
                               0.5 * (x[2] + x[0]), (1.0 / 3) * (x[0] + x[1] + x[2])}) {
            Point nearest;
            vtkIdType id = 0;
            int part = 0;
            double square = 0;
            locator->FindClosestPoint(p.data(), nearest.data(), cell, id, part, square);
            greatest = std::max(greatest, square);
        }
    }
    return std::sqrt(greatest);
}

double distance(vtkPolyData* a, vtkPolyData* b) {
    return std::max(one_sided_distance(a, b), one_sided_distance(b, a));
}

void compare(const Data& data, int n, int steps) {
    const Tetrahedra grid({.samples = {n, n, n}});
    const Samples field(grid, std::span<const float>(data.samples));
    vtkNew<vtkImageData> image = make_image(data.samples, n);
    vtkNew<vtkFlyingEdges3D> edges;
    edges->SetInputData(image);
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->ComputeScalarsOff();
    edges->SetValue(0, data.isovalue);
    vtkNew<vtkCleanPolyData> merged;
    merged->SetInputConnection(edges->GetOutputPort());
    merged->SetTolerance(0);
    merged->ConvertPolysToLinesOff();
    vtkNew<vtkQuadricDecimation> decimation;
    decimation->SetInputConnection(merged->GetOutputPort());
    merged->Update();
    const auto full = static_cast<double>(merged->GetOutput()->GetNumberOfPolys());
    const auto decimate_to = [&](double triangles) {
        decimation->SetTargetReduction(std::clamp(1 - triangles / full, 0.0, 0.9999));
        decimation->Update();
        return static_cast<double>(decimation->GetOutput()->GetNumberOfPolys());
    };

    nestgrid::Surface<3> surface;
    nestgrid::Collapsed result;
    std::size_t begun = 0;
    double ours = 0;
    Contest contest(1, Clock::processor);
    contest.add("draw_and_collapse", [&] {
        const nestgrid::HierarchicalIndicator deviations(erase(grid, field),
                                                         nestgrid::NodeError::deviation);
        // As the program does.
        const nestgrid::SweptIndicator cuts = nestgrid::cut_deviations(
            {grid, field}, std::span<const double>(&data.isovalue, 1), deviations);
        surface = nestgrid::isosurface(
                      grid, field, data.isovalue,
                      under(nestgrid::Threshold(&cuts, nestgrid::collapse_start * data.error),
                            deviations),
                      {.elements = false})
                      .surface;
        begun = surface.simplices.size();
        result =
            collapse(surface, erase(grid, field), data.isovalue, deviations, {.error = data.error});
        ours = static_cast<double>(surface.simplices.size());
    });
    contest.add("contour_and_decimate", [&] {
        edges->Modified();
        decimate_to(ours);
    });
    contest.run();

    const nestgrid::HierarchicalIndicator offsets(grid, field);
    const auto exact = to_vtk(
        nestgrid::isosurface(grid, field, data.isovalue, under(offsets, 0), {.elements = false})
            .surface);
    const double our_distance = distance(to_vtk(surface), exact);
    const double its_distance = distance(decimation->GetOutput(), merged->GetOutput());
    double too_few = ours / 4;
    double enough = std::min(full, 6 * ours);
    for (int step = 0; step < steps; ++step) {
        const double middle = std::sqrt(too_few * enough);
        const double left = decimate_to(middle);
        const bool near = distance(decimation->GetOutput(), merged->GetOutput()) <= our_distance;
        (near ? enough : too_few) = near ? left : middle;
    }
    const auto print = [&](const char* name, double value) {
        Contest::print_figure(data.name + "_" + name, value);
    };
    print("full_triangles", full);
    print("begun_triangles", static_cast<double>(begun));
    print("collapsed_triangles", ours);
    print("error_over_asked", result.error / data.error);
    print("exceeding_triangles", static_cast<double>(result.exceeding));
    print("distance", our_distance);
    print("quadric_distance", its_distance);
    print("triangles_over_quadric_at_equal_distance", ours / enough);
    print("collapse_ms", contest.time("draw_and_collapse"));
    print("collapse_over_quadric_time",
          contest.time("draw_and_collapse") / contest.time("contour_and_decimate"));
}

}  // namespace

int main(int argc, char** argv) {
    setenv("VTK_SMP_MAX_THREADS", "1", 1);  // read when VTK first looks for threads
    const auto asks = [&](const char* option) {
        return argc > 1 && std::strcmp(argv[1], option) == 0;
    };
    const int n = asks("--quick") ? 33 : asks("--large") ? 129 : 65;
    for (const Data& data : all_data(n)) compare(data, n, n == 33 ? 2 : 7);
    return 0;
}
