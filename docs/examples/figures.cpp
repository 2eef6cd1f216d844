// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws the figures of the documentation. Arguments: the name of a figure, and the PNG file to be
// written. The pages quote the parts between lines with a name in brackets.
#include <cstdio>
#include <map>
#include <string>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/adapters/red_green.hpp>
#include <nestgrid/algorithms/derived_field.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>

#include "colour_figure.hpp"
#include "discontinuous_figure.hpp"
#include "error_figures.hpp"
#include "growth_figures.hpp"
#include "indicator_figures.hpp"
#include "lens_figures.hpp"
#include "own_grid_figure.hpp"
#include "scenes.hpp"
#include "time_figure.hpp"

using namespace figures;

namespace {

void bucky_figure(const std::string& file) {
    const Bucky bucky;
    Picture picture(280, 280, 3);
    int view = 0;
    for (const double threshold : {0.0, 0.02, 0.1}) {
        const auto result = isosurface(bucky.grid, bucky.field, 0.275, {.threshold = threshold});
        draw_ball(picture, view++, result.surface);
        std::printf("threshold %g: %zu triangles\n", threshold, result.surface.simplices.size());
    }
    picture.write(file);
}

void isosurface_figure(const std::string& file) {
    OctreeGrid<3> grid(box(3));
    refine(
        grid, [](const Point& x) { return std::abs(rings(x)) * (x[0] > 0 ? 4 : 1); }, 3, 3, 0.03);
    const std::vector<double> u = values(grid, rings);
    // [isosurface]
    const NodeField<OctreeGrid<3>, double> field(grid, u);  // a vector of values by node number
    const auto result = isosurface(grid, field, 0.0, {.threshold = 0.002});

    const Surface<3>& surface = result.surface;
    const SurfaceReport report = surface_report(surface);
    std::printf("%zu triangles, %zu open edges, |U - C| <= %g\n", report.triangles,
                report.open_edges, result.error_bound);
    // [isosurface]
    Picture picture(700, 480, 1);
    picture.look(0, from_above);
    draw(picture, surface, true, by_level(surface));
    draw_slice(picture, grid, 0.0);
    picture.write(file);
}

/// Left: colours in the plane; right: the graph. Quadrilaterals of several sizes meet.
void height_field_figure(const std::string& file) {
    const auto rim = [](const Point& x) {
        const double r = std::hypot(x[0], x[1]) - 0.55;
        return 0.5 * std::exp(-60 * r * r) + 0.1 * x[0];
    };
    OctreeGrid<2> grid(box(2), {.balanced = false});
    refine(grid, rim, 2, 5, 0.004);
    const std::vector<double> u = values(grid, rim);
    const NodeField<OctreeGrid<2>, double> field(grid, u);
    Picture picture(480, 440, 2);
    for (const int view : {0, 1}) {
        const auto graph = height_field(grid, field, view, {.threshold = 0.004});
        const Surface<3>& s = graph.surface;
        if (view == 0) {
            picture.look(0, {.height = 2.1});
        } else {
            picture.look(1, {.towards_eye = {0.3, -1, 0.9}, .up = {0, 0, 1}, .height = 2.5});
        }
        draw(picture, s, true, [&](std::size_t t) {
            double sum = 0;
            for (const std::uint32_t v : s.simplices[t]) sum += s.attributes[v];
            return ramp((sum / 3 + 0.1) / 0.65);
        });
        std::printf("%zu triangles, at most %g off\n", s.simplices.size(), graph.error_bound);
    }
    picture.write(file);
}

void isoband_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [isoband]
    const HierarchicalIndicator indicator(grid, field);
    const auto band = isoband(grid, field, 0.15, 0.6, under(indicator, 0.02)).surface;
    const SurfaceReport report = surface_report(band);
    std::printf("volume %g, by volume_between() %g\n", report.volume,
                volume_between({grid, field}, 0.15, 0.6, under(indicator, 0.02)));
    // [isoband]
    Picture picture(480, 480, 1);
    picture.look(0, ball);
    const double middle = dot(ball.towards_eye, ball.centre);
    picture.cut_off(ball.towards_eye, middle);
    draw(picture, band, true, [&](std::size_t t) {
        const bool low = bucky.value(band.vertices[band.simplices[t][0]]) < 0.375;
        return low ? sand : ramp(0.2);
    });
    draw_section(picture, bucky, 0.15, 0.6);
    picture.write(file);
}

void series_figure(const std::string& file) {
    RedGreenSimplices<2> grid(two_triangles());
    refine(grid, hills, 2, 5, 0.008);
    const std::vector<double> u = values(grid, hills);
    const NodeField<RedGreenSimplices<2>, double> field(grid, u);
    Picture picture(480, 480, 1);
    picture.look(0, plane);
    draw_leaves(picture, grid);
    // [series]
    IsosurfaceSeries series(grid, field);  // computes the indicator, once
    for (int i = 0; i < 20; ++i) {
        const Surface<2>& line = series.draw(0.09 * i - 0.75, {.threshold = 0.002}).surface;
        draw(picture, line, hot(0.05 * i), 2.5);
    }
    // [series]
    picture.write(file);
}

void budget_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    Picture picture(280, 280, 3);
    int view = 0;
    // [budget]
    const Prerolls prerolls(grid, field);
    for (const std::uint64_t most : {80'000U, 30'000U, 10'000U}) {
        const auto result = isosurface<3>(prerolls, 0.275, {.max_triangles = most});
        std::printf("%zu triangles of %zu, |U - C| <= %g\n", result.surface.simplices.size(),
                    static_cast<std::size_t>(most), result.error_bound);
        draw_ball(picture, view++, result.surface);
    }
    // [budget]
    picture.write(file);
}

void region_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [region]
    const HierarchicalIndicator indicator(grid, field);
    const Point centre{48, 50, 40};
    const Region region(grid, [&](const Point& x) { return norm(x - centre) < 12; });
    const auto criterion = fine_inside(region, indicator, 0.1, 0.0);
    const auto result = isosurface(grid, field, 0.275, under(criterion, indicator));
    // [region]
    const auto criterion_at = [&](double outside) {
        return fine_inside(region, indicator, outside, 0.0);
    };
    const auto within =
        isosurface(grid, field, 0.275, under(criterion_at, indicator, {.max_triangles = 45'000}));
    Picture picture(380, 380, 2);
    int view = 0;
    for (const auto* surface : {&result.surface, &within.surface}) {
        draw_ball(picture, view++, *surface);
        std::printf("%zu triangles\n", surface->simplices.size());
    }
    picture.write(file);
}

// [criterion]
/// A small threshold at nodes on one side, a larger one on the other: not saturated, for a node on
/// the coarse side may have finer nodes on the other.
class TwoSides final : public Criterion {
public:
    explicit TwoSides(const Indicator& indicator) : indicator_{&indicator} {}
    NodeMask holds(const NewNodes& nodes) const override {
        NodeMask mask = 0;
        for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
            const double epsilon = nodes.positions[n][0] > 32 ? 0.002 : 0.1;
            if (indicator_->stop(nodes.keys[n]) <= epsilon) mask |= NodeMask{1} << n;
        }
        return mask & ~nodes.outside;
    }
    bool wants_positions() const override { return true; }
    bool saturated() const override { return false; }

private:
    const Indicator* indicator_;
};
// [criterion]

/// Edges of one triangle only that do not lie on the boundary of the domain.
void draw_open_edges(Picture& picture, const Surface<3>& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const auto& t : surface.simplices) {
        for (std::size_t i = 0; i < 3; ++i) ++uses[std::minmax(t[i], t[(i + 1) % 3])];
    }
    for (const auto& [edge, count] : uses) {
        if (count != 1) continue;
        picture.line(surface.vertices[edge.first], surface.vertices[edge.second], red, 2.5);
    }
}

void criteria_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [insist]
    const HierarchicalIndicator indicator(grid, field);
    const TwoSides two_sides(indicator);
    const auto open = isosurface(grid, field, 0.275, under(Unsaturated(two_sides), indicator));

    const Region side(grid, [](const Point& x) { return x[0] > 32; });
    const auto saturated = fine_inside(side, indicator, 0.1, 0.002);
    const auto closed = isosurface(grid, field, 0.275, under(saturated, indicator));
    // [insist]
    Picture picture(380, 380, 2);
    int view = 0;
    for (const auto* result : {&open, &closed}) {
        draw_ball(picture, view++, result->surface);
        draw_open_edges(picture, result->surface);
        const SurfaceReport report = surface_report(result->surface);
        std::printf("%zu triangles, %zu open edges, |U - C| <= %g\n", report.triangles,
                    report.open_edges, result->error_bound);
    }
    picture.write(file);
}

void levels_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    const HierarchicalIndicator indicator(grid, field);
    Picture picture(280, 280, 3);
    int view = 0;
    // [levels]
    const NodeLevels levels(grid);
    for (const int deepest : {18, 15, 12}) {
        const auto result =
            isosurface(grid, field, 0.275, under(levels.deeper_than(deepest), indicator));
        draw_ball(picture, view++, result.surface);
    }
    // [levels]
    picture.write(file);
}

void measures_figure(const std::string& file) {
    OctreeGrid<3> grid(box(3));
    refine(grid, drops, 4, 1, 0.01);
    const std::vector<double> u = values(grid, drops);
    const NodeField<OctreeGrid<3>, double> field(grid, u);
    const auto surface = isosurface(grid, field, 0.0).surface;
    // [measures]
    const SurfaceMeasurement measured = measure_surface(surface);
    for (const SurfaceMeasures& drop : measured.components) {
        std::printf("%5zu triangles, area %.3f, volume %.4f, %s\n", drop.triangles, drop.area,
                    drop.volume, drop.closed ? "closed" : "open");
    }
    const auto colour_of = [&](std::size_t triangle) {
        const std::uint32_t component = measured.component_of[triangle];
        return ramp(std::cbrt(measured.components[component].volume) / 0.6);
    };
    // [measures]
    Picture picture(640, 440, 1);
    picture.look(0, from_above);
    draw(picture, surface, true, colour_of);
    picture.write(file);
}

void hanging_figure(const std::string& file) {
    OctreeGrid<2> grid(box(2), {.balanced = false});
    refine(grid, hills, 2, 3, 0.02);
    const std::vector<double> u = values(grid, hills);
    const NodeField<OctreeGrid<2>, double> field(grid, u);
    Picture picture(480, 480, 1);
    picture.look(0, plane);
    draw_leaves(picture, grid);
    draw(picture, isosurface(grid, field, 0.25).surface, blue, 2.5);
    // [hanging]
    const HangingNodes hanging = derive_hanging_nodes(grid);
    const std::vector<Point> position = grid.node_positions();
    for (std::size_t node = 0; node < position.size(); ++node) {
        if (hanging.contains(node)) picture.dot(position[node], red, 3.5);
    }
    // [hanging]
    std::printf("%zu of %zu nodes hang\n", hanging.size(), position.size());
    picture.write(file);
}

/// A flow by the numbers of the nodes of an octree: three components a node.
class Flow {
public:
    using value_type = double;
    static constexpr int components = 3;

    Flow(const OctreeGrid<3>& grid, std::span<const Point> at_nodes)
        : grid_{&grid}, at_nodes_{at_nodes} {}
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        return copy(grid_->coarse_grid().element(i), out);
    }
    NodeMask new_values(const OctreeGrid<3>::Element& e, NodeMask, std::span<double> out,
                        OctreeGrid<3>::Context& context) const {
        return copy(grid_->new_nodes(e, context), out);
    }

private:
    NodeMask copy(std::span<const std::uint32_t> nodes, std::span<double> out) const {
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            std::ranges::copy(at_nodes_[nodes[k]],
                              out.begin() + static_cast<std::ptrdiff_t>(3 * k));
        }
        return 0;
    }
    const OctreeGrid<3>* grid_;
    std::span<const Point> at_nodes_;
};

/// The flow of Arnold, Beltrami and Childress.
Point flow_at(const Point& x) {
    return Point{std::sin(3 * x[2]) + std::cos(3 * x[1]), std::sin(3 * x[0]) + std::cos(3 * x[2]),
                 std::sin(3 * x[1]) + std::cos(3 * x[0])};
}

void derived_figure(const std::string& file) {
    OctreeGrid<3> grid(box(3));
    refine(
        grid, [&](const Point& x) { return norm(flow_at(x)); }, 5, 1, 0.02);
    std::vector<Point> velocity;
    for (const Point& x : grid.node_positions()) velocity.push_back(flow_at(x));
    const Flow flow(grid, velocity);
    // [derived]
    // Component 0 is the speed; the three components of the velocity come behind it.
    const DerivedField<Flow, Magnitude, 3> speed(flow);
    const auto surface = isosurface(grid, speed, 1.9, {.threshold = 0.001}).surface;
    const auto upwards = [&](std::size_t triangle) {
        const std::size_t vertex = surface.simplices[triangle][0];
        return surface.attributes[3 * vertex + 2];  // of the velocity, the third component
    };
    // [derived]
    Picture picture(560, 480, 1);
    picture.look(0, {.towards_eye = {-1, -2, 1.4}, .up = {0, 0, 1}, .height = 3.3});
    draw(picture, surface, false,
         [&](std::size_t triangle) { return ramp(0.5 + 0.25 * upwards(triangle)); });
    picture.write(file);
}

void norm_figure(const std::string& file) {
    OctreeGrid<3> grid(box(3));
    for (int i = 0; i < 5; ++i) grid.refine_uniformly();
    std::vector<Point> velocity;
    for (const Point& x : grid.node_positions()) velocity.push_back(flow_at(x));
    const Flow flow(grid, velocity);
    Picture picture(280, 280, 3);
    int view = 0;
    // [norm]
    const DerivedField<Flow, Magnitude, 3> speed(flow);  // the speed, and the velocity behind it
    const HierarchicalIndicator bounds(grid, speed);
    const SweptIndicator all = norm_indicator({grid, speed});
    for (const double epsilon : {0.05, 0.2, 0.8}) {
        const Threshold within(&all, epsilon);
        const auto surface = isosurface(grid, speed, 1.9, under(within, bounds)).surface;
        picture.look(view++, {.towards_eye = {-1, -2, 1.4}, .up = {0, 0, 1}, .height = 3.3});
        draw(picture, surface, true, [&](std::size_t triangle) {
            const std::size_t vertex = surface.simplices[triangle][0];
            return ramp(0.5 + 0.25 * surface.attributes[3 * vertex + 2]);
        });
        std::printf("threshold %g: %zu triangles\n", epsilon, surface.simplices.size());
    }
    // [norm]
    picture.write(file);
}

template <class Grid>
void draw_family(Picture& picture, int view, Grid grid, int uniformly, int adaptively) {
    const auto circle = [](const Point& x) { return norm(x - Point{-1, -1, 0}) - 1.2; };
    refine(
        grid, [&](const Point& x) { return std::abs(circle(x)); }, uniformly, adaptively, 0.03);
    picture.look(view, plane);
    draw_leaves(picture, grid);
    const std::vector<double> u = values(grid, circle);
    const NodeField<Grid, double> field(grid, u);
    draw(picture, isosurface(grid, field, 0.0).surface, blue, 2.5);
}

void families_figure(const std::string& file) {
    Picture picture(280, 280, 3);
    draw_family(picture, 0, RedGreenSimplices<2>(two_triangles()), 2, 3);
    draw_family(picture, 1, BisectionGrid<2>(two_triangles()), 4, 6);
    draw_family(picture, 2, OctreeGrid<2>(box(2)), 2, 3);
    picture.write(file);
}

}  // namespace

int main(int argc, char** argv) {
    const std::map<std::string, void (*)(const std::string&)> figures{
        {"bucky_ball", bucky_figure},
        {"isosurface", isosurface_figure},
        {"isoband", isoband_figure},
        {"isosurface_series", series_figure},
        {"budget", budget_figure},
        {"region", region_figure},
        {"error_asked", error_asked_figure},
        {"error_kept", error_kept_figure},
        {"error_told", error_told_figure},
        {"lens", lens_figure},
        {"blended", blended_figure},
        {"criteria", criteria_figure},
        {"levels", levels_figure},
        {"measures", measures_figure},
        {"hanging_nodes", hanging_figure},
        {"visual_indicator", visual_figure},
        {"numerical_indicator", numerical_figure},
        {"geometry_indicator", geometry_figure},
        {"wavelet_indicator", wavelet_figure},
        {"norm_indicator", norm_figure},
        {"derived_field", derived_figure},
        {"discontinuous", discontinuous_figure},
        {"families", families_figure},
        {"isosurface_growth", isosurface_growth_figure},
        {"slice_growth", slice_growth_figure},
        {"height_field", height_field_figure},
        {"own_grid", own_grid_figure},
        {"refine_colours", refine_colours_figure},
        {"time", time_figure}};
    const auto figure = argc == 3 ? figures.find(argv[1]) : figures.end();
    if (figure == figures.end()) {
        std::fprintf(stderr, "usage: figures NAME FILE.png, where NAME is one of");
        for (const auto& known : figures) std::fprintf(stderr, " %s", known.first.c_str());
        std::fprintf(stderr, "\n");
        return 2;
    }
    try {
        figure->second(argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
