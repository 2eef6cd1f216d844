// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of an adaptive octree, plane and curved, and its boundary: docs/slice.md and
// docs/boundary_surface.md go through it.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

using namespace nestgrid;

namespace {

/// A temperature with a front around one corner.
double heat(const Point& x) { return std::tanh(12 * (norm(x) - 0.8)) + 0.2 * x[2]; }

/// The unit cube, finer where the front is.
OctreeGrid<3> make_grid() {
    CoarseGrid cube;
    std::vector<Point> corners;
    for (unsigned k = 0; k < 8; ++k) {
        corners.push_back({double(k & 1U), double(k >> 1U & 1U), double(k >> 2U)});
    }
    cube.nodes = Coordinates(std::move(corners));
    cube.add(Shape::hexahedron, {0U, 1U, 2U, 3U, 4U, 5U, 6U, 7U});
    OctreeGrid<3> grid(cube);
    for (int level = 0; level < 6; ++level) {
        grid.adapt([&](const Leaf& leaf) {
            const double size = norm(leaf.corners.front() - leaf.centre());
            const bool at_front = std::abs(norm(leaf.centre()) - 0.8) < size;
            return level < 3 || at_front ? Mark::refine : Mark::keep;
        });
    }
    return grid;
}

// [own]
/// The distance from a torus around the middle of the cube, positive outside.
class Torus final : public LevelFunction {
public:
    double value(const Point& x) const override {
        return std::hypot(std::hypot(x[0] - 0.5, x[1] - 0.5) - 0.3, x[2] - 0.5) - 0.1;
    }
    /// No distance changes by more than the way.
    double variation(const Point&, double radius) const override { return radius; }
};
// [own]

std::size_t open_edges(const Slice& slice) { return surface_report(slice.surface).open_edges; }

}  // namespace

int main() {
    const OctreeGrid<3> grid = make_grid();
    std::vector<double> u;
    for (const Point& x : grid.node_positions()) u.push_back(heat(x));
    std::size_t open = 0;
    // [plane]
    const NodeField<OctreeGrid<3>, double> field(grid, u);  // a vector of values by node number
    const HierarchicalIndicator indicator(grid, field);
    const Plane plane({0.5, 0.5, 0.5}, {0, 1, 1});  // a point, and a normal of any length
    for (const double threshold : {0.0, 0.005, 0.05}) {
        const Slice s = slice(grid, field, plane, under(indicator, threshold));
        const auto [low, high] = std::ranges::minmax(s.surface.attributes);  // the temperatures
        std::printf("threshold %.3f: %5zu triangles, %.3f to %.3f, at most %.3f off\n", threshold,
                    s.surface.simplices.size(), low, high, s.error_bound);
        open += open_edges(s);
    }
    // [plane]
    // [together]
    const Sphere ball({0.5, 0.5, 0.5}, 0.4);
    const Torus torus;
    const SliceRequest request{.functions = {&plane, &ball, &torus}, .isovalues = {0.0}};
    const Threshold coarse(&indicator, 0.05);
    const std::vector<Slice> all = slices({grid, field}, request, under(coarse, indicator));
    // [together]
    // [fine]
    const NodeLevels levels(grid);
    const Slice fine = slice(grid, field, torus, under(coarse && levels.deeper_than(4), indicator));
    std::printf("torus: %zu triangles, with elements of level 4 and more %zu\n",
                all[2].surface.simplices.size(), fine.surface.simplices.size());
    // [fine]
    // [boundary]
    const Slice skin = boundary_surface(grid, field, under(coarse, indicator));
    // The part of the domain on the positive side, with its boundary: cut open along the plane.
    const Slice half = slice(grid, field, plane, under(coarse, indicator), {.cap = true});
    std::printf("boundary: %zu triangles, around volume %.3f; cut open: %zu, around %.3f\n",
                skin.surface.simplices.size(), surface_report(skin.surface).volume,
                half.surface.simplices.size(), surface_report(half.surface).volume);
    // [boundary]
    for (const Slice& s : all) open += open_edges(s);
    for (const Slice* s : {&fine, &skin, &half}) open += open_edges(*s);
    return open == 0 ? 0 : 1;
}
