// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Fewer triangles of the same error (docs/collapse.md).
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
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
    // [measure]
    const auto whole = isosurface(grid, field, isovalue).surface;
    const MeasuredError measured = measure_error(surface, whole, grid, field, isovalue);
    // [measure]
    std::printf("measured: |U - C| <= %.3f, distances %.4f there, %.4f back\n",
                measured.value.greatest, measured.distance.greatest, measured.back.greatest);
    const SurfaceReport report = surface_report(surface);
    const bool keeps = measured.value.greatest <= error && collapsed.error <= error;
    return report.closed() && report.manifold() && keeps ? 0 : 1;
}
