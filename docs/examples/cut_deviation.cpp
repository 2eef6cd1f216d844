// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The error of one surface, asked for and kept, beside that of all data (docs/criteria.md).
#include <array>
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 65;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    const auto usual = isosurface(grid, field, 0.275, under(deviations, 0.02));
    std::printf("deviations:     %zu triangles, %llu elements visited\n",
                usual.surface.simplices.size(),
                static_cast<unsigned long long>(usual.counts.visited));
    // [cut]
    const HierarchicalIndicator bounds(grid, field);
    const std::array isovalues{0.275};
    const SweptIndicator cuts = cut_deviations({grid, field}, isovalues, bounds);
    const auto result = isosurface(grid, field, 0.275, under(Threshold(&cuts, 0.02), bounds));
    // [cut]
    std::printf("cut deviations: %zu triangles, %llu elements visited, within %.4f\n",
                result.surface.simplices.size(),
                static_cast<unsigned long long>(result.counts.visited), result.surface_error);
    const SweptIndicator slopes = slope_deviations({grid, field}, isovalues, bounds);
    const auto near = isosurface(grid, field, 0.275, under(Threshold(&slopes, 0.25), bounds));
    std::printf("slopes:         %zu triangles at a quarter of a sample\n",
                near.surface.simplices.size());
    return surface_report(result.surface).open_edges == 0 && result.surface_error <= 0.02 ? 0 : 1;
}
