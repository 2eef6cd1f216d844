// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A terrain on a quadtree with hanging nodes, as an adaptive graph: docs/height_field.md quotes it.
#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

using namespace nestgrid;

namespace {

/// A crater: steep at its rim, smooth elsewhere.
double crater(const Point& x) {
    const double r = std::hypot(x[0] - 0.5, x[1] - 0.5);
    return 0.3 * std::exp(-400 * (r - 0.25) * (r - 0.25)) + 0.1 * x[0];
}

/// Quadrilaterals of the unit square, fine at the rim; one level may meet much finer ones.
OctreeGrid<2> terrain() {
    CoarseGrid square;
    square.dimension = 2;
    square.nodes = Coordinates({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    square.add(Shape::quadrilateral, {0, 1, 2, 3});
    OctreeGrid<2> grid(square, {.balanced = false});
    for (int level = 0; level < 4; ++level) grid.refine_uniformly();
    for (int level = 4; level < 8; ++level) {
        grid.adapt([](const Leaf& leaf) {
            const Point x = leaf.centre();
            const double r = std::hypot(x[0] - 0.5, x[1] - 0.5);
            return std::abs(r - 0.25) < 0.06 ? Mark::refine : Mark::keep;
        });
    }
    return grid;
}

}  // namespace

int main() {
    const OctreeGrid<2> grid = terrain();
    std::vector<double> heights;
    for (const Point& x : grid.node_positions()) heights.push_back(crater(x));

    std::size_t open = 0;
    // [height_field]
    const NodeField<OctreeGrid<2>, double> field(grid, heights);  // a number for each node
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : {0.0, 0.001, 0.01, 0.05}) {
        const Shading graph = height_field(grid, field, 2.0, under(indicator, threshold));
        const SurfaceReport report = surface_report(graph.surface);
        std::printf("threshold %5.3f: %5zu triangles, %zu open edges, at most %.4f off\n",
                    threshold, report.triangles, report.open_edges, graph.error_bound);
        open += report.open_edges;
    }
    // [height_field]
    return open == 0 ? 0 : 1;
}
