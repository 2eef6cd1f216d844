// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines of a plane grid, and isolines and outlines on an isosurface: docs/isolines.md and
// docs/outlines.md go through it.
#include <cmath>
#include <cstdio>
#include <vector>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/outlines.hpp>

using namespace nestgrid;

namespace {

CoarseGrid square() {
    CoarseGrid grid;
    grid.dimension = 2;
    grid.nodes = Coordinates({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    grid.add(Shape::quadrilateral, {0, 1, 2, 3});
    return grid;
}

CoarseGrid cube() {
    CoarseGrid grid;
    grid.nodes = Coordinates(
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}});
    grid.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    return grid;
}

/// Refines everywhere, and once more where x < 0.5.
template <class Grid>
Grid refined(const CoarseGrid& coarse) {
    Grid grid(coarse);
    for (int i = 0; i < 5; ++i) {
        grid.adapt([&](const Leaf& leaf) {
            return i < 4 || leaf.centre()[0] < 0.5 ? Mark::refine : Mark::keep;
        });
    }
    return grid;
}

/// The distance from the middle of the cube, and a temperature behind it.
class HeatedBall {
public:
    using value_type = double;
    static constexpr int components = 2;

    explicit HeatedBall(const OctreeGrid<3>& grid) : grid_{&grid} {
        for (const Point& x : grid.node_positions()) {
            distance_.push_back(norm(x - Point{0.5, 0.5, 0.5}));
            temperature_.push_back(20 + 30 * std::exp(-3 * x[2]) * std::cos(5 * x[0]));
        }
    }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return values(grid_->coarse_grid().element(i), out);
    }
    NodeMask new_values(const OctreeGrid<3>::Element& e, NodeMask, std::span<double> out,
                        OctreeGrid<3>::Context& context) const {
        return values(grid_->new_nodes(e, context), out);
    }

private:
    NodeMask values(std::span<const std::uint32_t> nodes, std::span<double> out) const {
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            out[2 * k] = distance_[nodes[k]];
            out[2 * k + 1] = temperature_[nodes[k]];
        }
        return 0;
    }

    const OctreeGrid<3>* grid_;
    std::vector<double> distance_;
    std::vector<double> temperature_;
};

bool draw_height_lines() {
    const auto grid = refined<OctreeGrid<2>>(square());
    std::vector<double> height;
    for (const Point& x : grid.node_positions()) {
        height.push_back(100 * std::sin(5 * x[0]) * std::sin(4 * x[1]));
    }
    // [plane]
    const NodeField<OctreeGrid<2>, double> field(grid, height);
    const std::vector<double> values{-50, 0, 50};
    const Isolines result = isolines(grid, field, values, {.threshold = 0.5});

    const Polylines& lines = result.lines;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        std::printf("%g: %s of %zu points, length %.3f\n", lines.value[i],
                    lines.closed(i) ? "ring" : "line", lines.line(i).size(), lines.length(i));
    }
    std::printf("the height differs by at most %.2g\n", result.error_bound);
    // [plane]
    return lines.count() > 0;
}

bool draw_isotherms() {
    const auto grid = refined<OctreeGrid<3>>(cube());
    const HeatedBall field(grid);
    // [surface]
    // Component 1 of the field, the temperature, is attribute 0 of the surface.
    const Surface<3> ball = isosurface(grid, field, 0.4, {.threshold = 1e-3}).surface;
    const std::vector<double> temperatures{15, 20, 25};
    const Polylines isotherms = isolines(ball, 0, temperatures);
    // [surface]
    std::printf("%zu isotherms\n", isotherms.count());
    // [outlines]
    const Surface<2> edges = outlines(ball);
    std::printf("%zu triangles, %zu segments of outlines\n", ball.simplices.size(),
                edges.simplices.size());
    // [outlines]
    bool closed = isotherms.count() > 0;
    for (std::size_t i = 0; i < isotherms.count(); ++i) closed = closed && isotherms.closed(i);
    return closed && !edges.simplices.empty();
}

}  // namespace

int main() {
    const bool plane = draw_height_lines();
    return draw_isotherms() && plane ? 0 : 1;
}
