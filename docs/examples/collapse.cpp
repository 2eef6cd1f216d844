// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same error (docs/collapse.md).
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 65;
    constexpr double isovalue = 0.275;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    // [collapse]
    constexpr double error = 0.02;
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    auto surface = isosurface(grid, field, isovalue, deviations, {.threshold = error / 2}).surface;
    const std::size_t drawn = surface.simplices.size();
    const Collapsed collapsed =
        collapse(surface, grid, field, isovalue, deviations, {.error = error});
    // [collapse]
    std::printf("%zu triangles, then %zu, |U - C| <= %.3f\n", drawn, surface.simplices.size(),
                collapsed.error);
    const SurfaceReport report = surface_report(surface);
    return report.closed() && report.manifold() && collapsed.error <= error ? 0 : 1;
}
