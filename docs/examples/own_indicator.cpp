// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A criterion of one's own: docs/criteria.md goes through it.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/algorithms/swept_indicator.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 33;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    // [own]
    // Relative to the data: offsets of small values count more than those of large ones.
    const auto relative = [](const MeasuredSplit& split, std::span<double> eta) {
        for (std::size_t i = 0; i < eta.size(); ++i) {
            eta[i] = std::abs(split.offset(i)) / std::max(std::abs(split.means[i]), 0.1);
        }
    };
    const SweptIndicator own = measured_indicator({grid, field}, relative);
    const HierarchicalIndicator bounds(grid, field);
    const auto result = isosurface(grid, field, 0.275, under(Threshold(&own, 0.2), bounds));
    // [own]
    const SurfaceReport report = surface_report(result.surface);
    std::printf("%zu triangles, %zu open edges, |U - C| <= %g\n", report.triangles,
                report.open_edges, result.error_bound);
    return report.triangles > 0 && report.open_edges == 0 ? 0 : 1;
}
