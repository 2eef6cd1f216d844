// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A profile along a line through an adaptive octree: docs/probe.md goes through it.
#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/probe_line.hpp>

using namespace nestgrid;

namespace {

double layer(const Point& x) { return std::tanh(20 * (norm(x) - 0.7)); }

/// The unit cube, finer where the function is steep.
OctreeGrid<3> make_grid() {
    CoarseGrid cube;
    std::vector<Point> corners;
    for (unsigned k = 0; k < 8; ++k) {
        corners.push_back({double(k & 1U), double(k >> 1U & 1U), double(k >> 2U)});
    }
    cube.nodes = Coordinates(std::move(corners));
    cube.add(Shape::hexahedron, {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U});
    OctreeGrid<3> grid(cube);
    for (int level = 0; level < 5; ++level) {
        grid.adapt([](const Leaf& leaf) {
            const double size = norm(leaf.corners.front() - leaf.centre());
            return std::abs(norm(leaf.centre()) - 0.7) < 2 * size ? Mark::refine : Mark::keep;
        });
    }
    return grid;
}

}  // namespace

int main() {
    const OctreeGrid<3> grid = make_grid();
    std::vector<double> u;
    for (const Point& x : grid.node_positions()) u.push_back(layer(x));
    // [use]
    const NodeField<OctreeGrid<3>, double> field(grid, u);  // a vector of values by node number
    const LineProbe line = probe_line(grid, field, {0, 0, 0}, {0.9, 0.6, 1.2}, 9);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
        if (line.found(i)) {
            std::printf("%.3f  %6.3f  level %d\n", line.distance[i], line.values[i], line.level[i]);
        } else {
            std::printf("%.3f  outside\n", line.distance[i]);
        }
    }
    // [use]
    // [threshold]
    const HierarchicalIndicator indicator(grid, field);
    const std::vector<Point> points{{0.4, 0.4, 0.4}, {0.1, 0.2, 0.3}};
    const ProbeResult coarse = probe(grid, field, points, under(indicator, 0.05));  // P_S U
    // [threshold]
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::printf("%.3f at threshold 0.05, level %d\n", coarse.values[i], coarse.level[i]);
    }
    return 0;
}
