// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// An error that is asked for and kept, beside the same threshold on offsets (docs/criteria.md).
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 65;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    const HierarchicalIndicator offsets(grid, field);
    const auto usual = isosurface(grid, field, 0.275, under(offsets, 0.02));
    std::printf("offsets:    %zu triangles, |U - C| <= %.3f\n", usual.surface.simplices.size(),
                usual.error_bound);
    // [deviation]
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    const auto result = isosurface(grid, field, 0.275, under(deviations, 0.02));
    // [deviation]
    std::printf("deviations: %zu triangles, |U - C| <= %.3f\n", result.surface.simplices.size(),
                result.error_bound);
    return surface_report(result.surface).open_edges == 0 && result.error_bound <= 0.02 ? 0 : 1;
}
