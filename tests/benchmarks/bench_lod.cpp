// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A simpler surface with a known error: by a threshold while extracting, or by VTK's contour and
// vtkQuadricDecimation afterwards. Errors are the largest |U - C| at seven points of every
// triangle, U trilinear between the samples of the bucky ball. For each threshold VTK's target
// reduction is the greatest that keeps within our error. One "name value" line per figure; --quick
// takes 33^3 samples instead of 129^3.
#include <cstdlib>

#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkQuadricDecimation.h>

#include "bucky_samples.hpp"

namespace {

using nestgrid::Point;
using nestgrid::operator*;
using nestgrid::operator+;

class Trilinear {
public:
    Trilinear(const std::vector<float>& samples, int n) : samples_{&samples}, n_{n} {}

    double at(const Point& x) const {
        std::array<std::size_t, 3> cell;
        Point local;
        for (std::size_t d = 0; d < 3; ++d) {
            const double c = std::clamp(std::floor(x[d]), 0.0, n_ - 2.0);
            cell[d] = static_cast<std::size_t>(c);
            local[d] = x[d] - c;
        }
        const auto n = static_cast<std::size_t>(n_);
        double sum = 0;
        for (std::size_t corner = 0; corner < 8; ++corner) {
            double weight = 1;
            std::size_t index = 0;
            std::size_t stride = 1;
            for (std::size_t d = 0; d < 3; ++d, stride *= n) {
                const std::size_t up = corner >> d & 1U;
                weight *= up == 1 ? local[d] : 1 - local[d];
                index += (cell[d] + up) * stride;
            }
            sum += weight * static_cast<double>((*samples_)[index]);
        }
        return sum;
    }

    /// Largest |U - C| at corners, edge midpoints and centre.
    double error(const Point& a, const Point& b, const Point& c) const {
        double largest = 0;
        const double isovalue = bucky_isovalue;
        for (const Point& w : {Point{1, 0, 0},
                               {0, 1, 0},
                               {0, 0, 1},
                               {.5, .5, 0},
                               {.5, 0, .5},
                               {0, .5, .5},
                               {1. / 3, 1. / 3, 1. / 3}}) {
            largest = std::max(largest, std::abs(at(w[0] * a + w[1] * b + w[2] * c) - isovalue));
        }
        return largest;
    }

private:
    const std::vector<float>* samples_;
    int n_;
};

double error(const Trilinear& u, vtkPolyData* surface) {
    double largest = 0;
    for (vtkIdType i = 0; i < surface->GetNumberOfCells(); ++i) {
        vtkIdType count = 0;
        const vtkIdType* ids = nullptr;
        surface->GetCellPoints(i, count, ids);
        std::array<Point, 3> x;
        for (std::size_t k = 0; k < 3; ++k) surface->GetPoint(ids[k], x[k].data());
        largest = std::max(largest, u.error(x[0], x[1], x[2]));
    }
    return largest;
}

void compare(int n, std::size_t rounds) {
    BuckySamples bucky(n);
    const Trilinear u(bucky.samples, n);
    vtkNew<vtkImageData> image;
    image->SetDimensions(n, n, n);
    vtkNew<vtkFloatArray> array;
    array->SetArray(bucky.samples.data(), static_cast<vtkIdType>(bucky.samples.size()), 1);
    image->GetPointData()->SetScalars(array);
    vtkNew<vtkFlyingEdges3D> edges;
    edges->SetInputData(image);
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->ComputeScalarsOff();
    edges->SetValue(0, double{bucky_isovalue});
    vtkNew<vtkQuadricDecimation> decimation;
    decimation->SetInputConnection(edges->GetOutputPort());
    for (const float threshold : {0.005F, 0.01F, 0.02F}) {
        const std::size_t triangles = bucky.draw_soup(bucky.grid, bucky.field, threshold);
        double ours = 0;
        for (std::size_t i = 0; i < triangles; ++i) {
            const Triangle& t = bucky.soup[i];
            ours =
                std::max(ours, u.error({t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}));
        }
        double within = 0;
        double beyond = 0.99;
        for (int step = 0; step < 6; ++step) {
            const double middle = (within + beyond) / 2;
            decimation->SetTargetReduction(middle);
            decimation->Update();
            (error(u, decimation->GetOutput()) <= ours ? within : beyond) = middle;
        }
        decimation->SetTargetReduction(within);
        decimation->Update();
        const auto left = static_cast<double>(decimation->GetOutput()->GetNumberOfCells());
        Contest contest(rounds);
        contest.add("ours", [&] { bucky.draw_soup(bucky.grid, bucky.field, threshold); });
        contest.add("quadric", [&] {
            edges->Modified();
            decimation->Update();
        });
        contest.run();
        const auto print = [&](const char* name, double value) {
            Contest::print_figure(at_threshold(name, threshold), value);
        };
        print("error", ours);
        print("our_triangles", static_cast<double>(triangles));
        print("quadric_triangles", left);
        print("our_triangles_over_quadric", static_cast<double>(triangles) / left);
        print("our_ms", contest.time("ours"));
        print("lod_quadric_over_ours", contest.time("quadric") / contest.time("ours"));
    }
}

}  // namespace

int main(int argc, char** argv) {
    setenv("VTK_SMP_MAX_THREADS", "1", 1);  // read when VTK first looks for threads
    at_either_size(argc, argv, 5, [](auto n, std::size_t rounds) { compare(n.value, rounds); });
    return 0;
}
