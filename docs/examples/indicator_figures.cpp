// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Figures of surfaces at three thresholds of an indicator.
#include "indicator_figures.hpp"

#include <cstdio>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "scenes.hpp"

namespace figures {

namespace {

/// Draws the bucky ball at three thresholds of an indicator into a file.
void draw_thresholds(const std::string& file, const Bucky& bucky, const Indicator& indicator,
                     const Bounds& bounds, const std::array<double, 3>& thresholds) {
    Picture picture(280, 280, 3);
    int view = 0;
    for (const double threshold : thresholds) {
        const Threshold s(&indicator, threshold);
        const auto result = isosurface(bucky.grid, bucky.field, 0.275, under(s, bounds));
        draw_ball(picture, view++, result.surface);
        std::printf("threshold %g: %zu triangles, |U - C| <= %g\n", threshold,
                    result.surface.simplices.size(), result.error_bound);
    }
    picture.write(file);
}

// [round]
/// The triangles of an octahedron, bisected. All nodes lie on a bumpy ball.
class BumpyBall : public BisectionGrid<2> {
public:
    explicit BumpyBall(const BisectionGrid<2>& flat)
        : BisectionGrid<2>(flat), at_nodes_{flat.node_positions()} {
        for (Point& x : at_nodes_) x = on_ball(x);
    }
    void new_positions(const Element& e, NodeMask, std::span<Point> out, Context& context) const {
        const std::span<const std::uint32_t> nodes = new_nodes(e, context);
        for (std::size_t n = 0; n < nodes.size(); ++n) out[n] = at_nodes_[nodes[n]];
    }

private:
    static Point on_ball(const Point& x);
    std::vector<Point> at_nodes_;
};
// [round]

Point BumpyBall::on_ball(const Point& x) {
    const Point unit = 1 / norm(x) * x;
    const Point from_bump = unit - 1 / std::sqrt(3.0) * Point{-1, -1, 1};
    const double bump = std::exp(-8 * dot(from_bump, from_bump)) * std::cos(14 * norm(from_bump));
    return (1 + 0.15 * bump) * unit;
}

}  // namespace

void visual_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [visual]
    const HierarchicalIndicator bounds(grid, field);
    const double range = bounds.greatest() - bounds.least();
    const SweptIndicator visual = visual_indicator({grid, field}, {.tau = 0x1p-20 * range});
    const Threshold folds(&visual, 0.5);  // of at most 29 degrees: 2 sin(29 / 2)
    const auto result = isosurface(grid, field, 0.275, under(folds, bounds));
    // [visual]
    std::printf("%zu triangles\n", result.surface.simplices.size());
    draw_thresholds(file, bucky, visual, bounds, {0.25, 0.5, 1});
}

void numerical_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [numerical]
    const HierarchicalIndicator bounds(grid, field);
    const SweptIndicator numerical = numerical_indicator({grid, field});
    const Threshold jumps(&numerical, 0.2);
    const auto result = isosurface(grid, field, 0.275, under(jumps, bounds));
    // [numerical]
    std::printf("%zu triangles\n", result.surface.simplices.size());
    draw_thresholds(file, bucky, numerical, bounds, {0.1, 0.2, 0.8});
}

void wavelet_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [wavelet]
    const HierarchicalIndicator bounds(grid, field);
    const SweptIndicator wavelet = wavelet_indicator({grid, field});
    const Threshold detail(&wavelet, 0.05);
    const auto result = isosurface(grid, field, 0.275, under(detail, bounds));
    // [wavelet]
    std::printf("%zu triangles\n", result.surface.simplices.size());
    draw_thresholds(file, bucky, wavelet, bounds, {0.01, 0.05, 0.15});
}

void geometry_figure(const std::string& file) {
    CoarseGrid octahedron;
    octahedron.dimension = 2;
    octahedron.nodes =
        Coordinates({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
    for (const std::array<std::uint32_t, 3>& t : {std::array<std::uint32_t, 3>{0, 2, 4},
                                                  {2, 1, 4},
                                                  {1, 3, 4},
                                                  {3, 0, 4},
                                                  {2, 0, 5},
                                                  {1, 2, 5},
                                                  {3, 1, 5},
                                                  {0, 3, 5}}) {
        octahedron.add(Shape::triangle, t);
    }
    BisectionGrid<2> flat(octahedron);
    for (int i = 0; i < 12; ++i) flat.refine_uniformly();
    const BumpyBall grid(flat);
    const std::vector<double> heights(grid.node_count(), 0.0);
    const NodeField<BisectionGrid<2>, double> field(grid, heights);
    Picture picture(280, 280, 3);
    int view = 0;
    // [geometry]
    const HierarchicalIndicator data(grid, field);  // sees nothing: the data are constant
    const SweptIndicator bounds = position_bounds({grid, field});
    for (const double epsilon : {0.002, 0.01, 0.05}) {
        const Threshold within(&bounds, epsilon);  // no point is farther off than epsilon
        const Surface<3> surface = shading(grid, field, under(within, data)).surface;
        picture.look(view++, {.towards_eye = {-1, -2, 1.6}, .up = {0, 0, 1}, .height = 2.3});
        draw(picture, surface, true, [](std::size_t) { return sand; });
        std::printf("within %g: %zu triangles\n", epsilon, surface.simplices.size());
    }
    // [geometry]
    picture.write(file);
}

}  // namespace figures
