// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What bench_python.py compares the Python package with: from samples of a gyroid to the arrays of
// an isosurface, on one thread. Prints the least processor time in ms, one threshold a line.
// Arguments: samples along each direction, how often.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <numbers>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

int main(int argc, char** argv) {
    if (argc != 3) return 1;
    const int n = std::atoi(argv[1]);
    std::vector<float> samples;
    const auto angle = [&](int i) { return 4 * std::numbers::pi * i / (n - 1); };
    for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) {
            for (int i = 0; i < n; ++i) {
                const double x = angle(i), y = angle(j), z = angle(k);
                samples.push_back(static_cast<float>(std::sin(x) * std::cos(y) +
                                                     std::sin(y) * std::cos(z) +
                                                     std::sin(z) * std::cos(x)));
            }
        }
    }
    for (const double threshold : {0.0, 0.05}) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t triangles = 0;
        for (int i = 0; i < std::atoi(argv[2]); ++i) {
            const std::clock_t start = std::clock();
            const nestgrid::LatticeBisection<3> grid({.samples = {n, n, n}});
            const nestgrid::LatticeField field(grid, std::span<const float>(samples));
            const auto result = nestgrid::isosurface(grid, field, 0.1, {.threshold = threshold},
                                                     {.normals = true, .elements = false});
            least =
                std::min(least, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
            triangles = result.surface.simplices.size();
        }
        std::printf("%g %zu\n", least, triangles);
    }
    return 0;
}
