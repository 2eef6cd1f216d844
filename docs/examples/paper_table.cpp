// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The second table of section 9 of the paper on a synthetic bucky ball of 129^3 samples, as the
// Markdown table of docs/paper_table.md.
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "bucky_ball.hpp"

namespace {

struct Row {
    double threshold;
    long triangles;  // of the paper
    long visited;
};

constexpr Row paper[] = {{0.02, 81184, 201757},     {0.01, 128709, 307384},
                         {0.005, 211219, 487107},   {0.0025, 315440, 727419},
                         {0.00125, 439230, 984029}, {0, 590018, 1259669}};

}  // namespace

int main() {
    const int n = 129;
    const double isovalue = 0.275;
    const std::vector<float> samples = bucky_ball(n);
    const nestgrid::LatticeBisection<3> grid({.samples = {n, n, n}});
    const nestgrid::LatticeField field(grid, std::span<const float>(samples));
    const nestgrid::HierarchicalIndicator indicator(grid, field);

    std::printf(
        "| threshold | triangles (paper) | triangles | visited (paper) | visited | inspect "
        "calls | extracted | open edges | bound |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|\n");
    bool closed = true;
    for (const Row& row : paper) {
        const auto result =
            nestgrid::isosurface(grid, field, isovalue, under(indicator, row.threshold));
        const nestgrid::SurfaceReport report = nestgrid::surface_report(result.surface);
        closed = closed && report.closed() && report.manifold();
        std::printf("| %g | %ld | %zu | %ld | %llu | %llu | %llu | %zu | %.4g |\n", row.threshold,
                    row.triangles, report.triangles, row.visited,
                    static_cast<unsigned long long>(result.counts.visited),
                    static_cast<unsigned long long>(result.counts.calls),
                    static_cast<unsigned long long>(result.counts.extracted), report.open_edges,
                    result.error_bound);
    }
    return closed ? 0 : 1;
}
