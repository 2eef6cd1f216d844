// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A page for browsers that shows a surface while a program computes it: a drop parts in two, ten
// steps a second. Behind the last step the page stays until Enter.
//     live [steps]
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
// [page]
#include <nestgrid/view/page.hpp>
// [page]

namespace {

constexpr int samples = 65;

double square_from(const nestgrid::Point& x, double centre) {
    return std::pow(x[0] - centre, 2) + std::pow(x[1] - 32, 2) + std::pow(x[2] - 32, 2);
}

/// The sum of two bells that move apart.
std::vector<float> drops(double time) {
    std::vector<float> values;
    for (int z = 0; z < samples; ++z) {
        for (int y = 0; y < samples; ++y) {
            for (int x = 0; x < samples; ++x) {
                const nestgrid::Point at{double(x), double(y), double(z)};
                values.push_back(float(std::exp(-square_from(at, 32 - 18 * time) / 160) +
                                       std::exp(-square_from(at, 32 + 18 * time) / 160)));
            }
        }
    }
    return values;
}

}  // namespace

int main(int argc, char** argv) {
    const int steps = argc > 1 ? std::atoi(argv[1]) : 100;
    const nestgrid::LatticeBisection<3> grid({.samples = {samples, samples, samples}});

    // [serve]
    nestgrid::view::Page page({.title = "A drop parts", .box = {{{0, 0, 0}, {64, 64, 64}}}});
    std::printf("%s\n", page.address().c_str());
    // [serve]
    std::fflush(stdout);
    for (int step = 0; step <= steps; ++step) {
        const double time = double(step) / steps;
        const std::vector<float> values = drops(time);
        const nestgrid::LatticeField field(grid, std::span<const float>(values));
        // [push]
        nestgrid::Surface<3> surface =
            nestgrid::isosurface(grid, field, 0.5, {.threshold = 0.002}).surface;
        for (const nestgrid::Point& x : surface.vertices) {
            surface.attributes.push_back(20 + 60 * std::exp(-square_from(x, 32) / 200));
        }
        page.push(std::move(surface), {.time = time, .step = step, .field = "temperature"});
        // [push]
        std::this_thread::sleep_for(std::chrono::milliseconds{100});
    }
    std::getchar();
}
