// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

int main() {
    std::vector<float> samples;
    for (int z = -16; z <= 16; ++z) {
        for (int y = -16; y <= 16; ++y) {
            for (int x = -16; x <= 16; ++x) samples.push_back(std::hypot(x, y, float(z)));
        }
    }
    const nestgrid::LatticeBisection<3> grid({.samples = {33, 33, 33}});
    const nestgrid::LatticeField field(grid, std::span<const float>(samples));
    const auto sphere = nestgrid::isosurface(grid, field, 12.0, {.threshold = 0.1});
    const auto report = nestgrid::surface_report(sphere.surface);
    std::printf("%zu triangles, %zu open edges\n", report.triangles, report.open_edges);
    return report.closed() && report.euler == 2 ? 0 : 1;
}
