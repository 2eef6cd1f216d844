// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws the figures of the documentation. Arguments: the name of a figure, and the PNG file to be
// written. The pages quote the parts between lines with a name in brackets.
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/adapters/red_green.hpp>
#include <nestgrid/algorithms/derived_field.hpp>
#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/node_levels.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "bucky_ball.hpp"
#include "picture.hpp"

using namespace nestgrid;

namespace {

constexpr Colour sand{0.93, 0.85, 0.70};
constexpr Colour red{0.85, 0.10, 0.10};
constexpr Colour blue{0.10, 0.35, 0.75};
constexpr Colour grey{0.70, 0.73, 0.78};

/// From blue over green to yellow; t between 0 and 1.
Colour ramp(double t) {
    static constexpr std::array<Colour, 4> stop{
        Colour{0.29, 0.33, 0.65}, {0.16, 0.58, 0.65}, {0.40, 0.78, 0.45}, {0.96, 0.86, 0.30}};
    const double at = std::clamp(t, 0.0, 1.0) * 3;
    const auto i = std::min(static_cast<std::size_t>(at), std::size_t{2});
    Colour c{};
    for (std::size_t d = 0; d < 3; ++d) {
        c[d] = stop[i][d] + (at - static_cast<double>(i)) * (stop[i + 1][d] - stop[i][d]);
    }
    return c;
}

/// From blue over violet to red.
Colour hot(double t) { return {0.10 + 0.75 * t, 0.25 * (1 - t), 0.75 * (1 - t) + 0.1}; }

/// \param colour_of called with the number of each triangle
template <class ColourOf>
void draw(Picture& picture, const Surface<3>& surface, bool edges, const ColourOf& colour_of) {
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& [a, b, c] = surface.simplices[t];
        picture.triangle({surface.vertices[a], surface.vertices[b], surface.vertices[c]},
                         colour_of(t), edges);
    }
}

void draw(Picture& picture, const Surface<2>& lines, const Colour& colour, double width) {
    for (const auto& [a, b] : lines.simplices) {
        picture.line(lines.vertices[a], lines.vertices[b], colour, width);
    }
}

/// The colour of the level of the element that a triangle comes from.
auto by_level(const Surface<3>& surface) {
    const auto [least, most] = std::ranges::minmax(surface.level_of);
    return [&surface, least = least, range = std::max(most - least, 1)](std::size_t t) {
        return ramp(double(surface.level_of[surface.element_of[t]] - least) / range);
    };
}

/// The square or the cube between -1 and 1.
CoarseGrid box(int dimension) {
    CoarseGrid grid;
    grid.dimension = dimension;
    std::vector<Point> corners;
    for (unsigned k = 0; k < 1U << dimension; ++k) {
        corners.push_back({k & 1U ? 1.0 : -1.0, k & 2U ? 1.0 : -1.0,
                           dimension == 2 ? 0.0
                           : k & 4U       ? 1.0
                                          : -1.0});
    }
    grid.nodes = Coordinates(std::move(corners));
    if (dimension == 2) {
        grid.add(Shape::quadrilateral, {0, 1, 2, 3});
    } else {
        grid.add(Shape::hexahedron, {0, 1, 2, 3, 4, 5, 6, 7});
    }
    return grid;
}

CoarseGrid two_triangles() {
    CoarseGrid grid = box(2);
    CoarseGrid cut;
    cut.dimension = 2;
    cut.nodes = grid.nodes;
    cut.add(Shape::triangle, {0, 1, 3});
    cut.add(Shape::triangle, {0, 3, 2});
    return cut;
}

/// Refines uniformly, then wherever the mean of the corner values of a leaf misses the value at its
/// centre by more than the tolerance.
template <class Grid, class Function>
void refine(Grid& grid, const Function& u, int uniformly, int adaptively, double tolerance) {
    for (int step = 0; step < uniformly; ++step) grid.refine_uniformly();
    for (int step = 0; step < adaptively; ++step) {
        grid.adapt([&](const Leaf& leaf) {
            double mean = 0;
            for (const Point& x : leaf.corners) mean += u(x) / double(leaf.corners.size());
            return std::abs(mean - u(leaf.centre())) > tolerance ? Mark::refine : Mark::keep;
        });
    }
}

template <class Grid, class Function>
std::vector<double> values(const Grid& grid, const Function& u) {
    std::vector<double> result;
    for (const Point& x : grid.node_positions()) result.push_back(u(x));
    return result;
}

/// Draws the edges of the leaves of a grid of dimension 2.
template <class Grid>
void draw_leaves(Picture& picture, const Grid& grid) {
    grid.for_each_leaf([&](const Leaf& leaf) {
        const Topology& t = topology(leaf.shape);
        for (std::size_t i = 0; i < t.edges; ++i) {
            picture.line(leaf.corners[t.edge[i][0]], leaf.corners[t.edge[i][1]], grey, 0.8);
        }
    });
}

/// Draws where the leaves of an octree meet the plane z = height.
void draw_slice(Picture& picture, const OctreeGrid<3>& grid, double height) {
    grid.for_each_leaf([&](const Leaf& leaf) {
        const Point low = leaf.corners.front();
        const Point high = leaf.corners.back();
        if (height < low[2] || height >= high[2]) return;
        const std::array<Point, 4> loop{Point{low[0], low[1], height},
                                        {high[0], low[1], height},
                                        {high[0], high[1], height},
                                        {low[0], high[1], height}};
        for (std::size_t i = 0; i < 4; ++i) picture.line(loop[i], loop[(i + 1) % 4], grey, 0.8);
    });
}

/// Two linked rings: negative inside.
double rings(const Point& x) {
    const auto ring = [](double along, double across, double height) {
        return std::hypot(std::hypot(along, across) - 0.5, height) - 0.17;
    };
    return std::min(ring(x[0] + 0.25, x[1], x[2]), ring(x[0] - 0.25, x[2], x[1]));
}

/// Hills and hollows over the square.
double hills(const Point& x) {
    const auto hill = [&x](double a, double b, double steep) {
        return std::exp(-steep * (std::pow(x[0] - a, 2) + std::pow(x[1] - b, 2)));
    };
    return hill(0.45, 0.4, 25) + 0.7 * hill(-0.4, -0.5, 5) - 0.8 * hill(-0.5, 0.5, 8) -
           0.5 * hill(0.6, -0.5, 12);
}

/// A few drops of different size: positive inside.
double drops(const Point& x) {
    static constexpr std::array<std::array<double, 4>, 7> drop{{{-0.45, 0.35, 0.2, 0.34},
                                                                {0.4, -0.4, 0.25, 0.38},
                                                                {-0.3, -0.45, -0.3, 0.28},
                                                                {0.35, 0.4, -0.35, 0.25},
                                                                {0.6, 0.3, 0.5, 0.14},
                                                                {-0.7, -0.1, 0.65, 0.12},
                                                                {-0.05, 0.1, -0.65, 0.16}}};
    double nearest = -2;
    for (const auto& [a, b, c, r] : drop) nearest = std::max(nearest, r - norm(x - Point{a, b, c}));
    return nearest;
}

const View from_above{.towards_eye = {-1, -2, 1.6}, .up = {0, 0, 1}, .height = 2.1};
const View ball{
    .towards_eye = {1.1, 1.5, 0.7}, .up = {0, 0, 1}, .centre = {32, 32, 32}, .height = 64};
const View plane{.height = 2.06};

/// The samples of the bucky ball with 65 a side, and their hierarchy of tetrahedra.
struct Bucky {
    LatticeBisection<3> grid{{.samples = {65, 65, 65}}};
    std::vector<float> samples = bucky_ball(65);
    LatticeField<LatticeBisection<3>, float> field{grid, std::span<const float>(samples)};

    /// Of the trilinear interpolant, at a point of the domain.
    double value(const Point& x) const {
        double sum = 0;
        for (std::size_t k = 0; k < 8; ++k) {
            double weight = 1;
            std::size_t sample = 0;
            for (std::size_t d = 3; d-- > 0;) {
                const auto cell =
                    std::clamp(static_cast<std::size_t>(x[d]), std::size_t{0}, std::size_t{63});
                const double part = x[d] - static_cast<double>(cell);
                weight *= (k >> d & 1U) != 0 ? part : 1 - part;
                sample = 65 * sample + cell + (k >> d & 1U);
            }
            sum += weight * double(samples[sample]);
        }
        return sum;
    }
};

/// Paints the part of the plane through the middle, across the view, where low <= U < high.
void draw_section(Picture& picture, const Bucky& bucky, double low, double high) {
    const auto unit = [](const Point& a) { return 1 / norm(a) * a; };
    constexpr double step = 0.1;
    constexpr double side = 1.1;  // of a small square, in steps: they overlap
    const Point right = step * unit(cross(ball.up, ball.towards_eye));
    const Point up = step * unit(cross(ball.towards_eye, right));
    for (int i = -300; i < 300; ++i) {
        for (int k = -300; k < 300; ++k) {
            const Point x = ball.centre + double(i) * right + double(k) * up;
            if (std::ranges::min(x) < 0 || std::ranges::max(x) > 64) continue;
            const double u = bucky.value(x);
            if (u < low || u >= high) continue;
            const Point behind = x - 0.01 * ball.towards_eye;
            const Point a = behind + side * right;
            const Point b = behind + side * up;
            picture.triangle({behind, a, b}, ramp(1), false);
            picture.triangle({a, b + side * right, b}, ramp(1), false);
        }
    }
}

void bucky_figure(const std::string& file) {
    const Bucky bucky;
    Picture picture(280, 280, 3);
    int view = 0;
    for (const double threshold : {0.0, 0.02, 0.1}) {
        const auto result = isosurface(bucky.grid, bucky.field, 0.275, {.threshold = threshold});
        picture.look(view++, ball);
        draw(picture, result.surface, true, [](std::size_t) { return sand; });
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

void isoband_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    // [isoband]
    const HierarchicalIndicator indicator(grid, field);
    const auto band =
        isoband(grid, field, 0.15, 0.6, Threshold(&indicator, 0.02), indicator).surface;
    const SurfaceReport report = surface_report(band);
    std::printf("volume %g, by volume_between() %g\n", report.volume,
                volume_between(grid, field, 0.15, 0.6, indicator, 0.02));
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
    IsosurfaceSeries series(grid, field);  // the preroll, once
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
    const HierarchicalIndicator indicator(grid, field);
    for (const std::uint64_t most : {80'000, 30'000, 10'000}) {
        const auto result = isosurface(grid, field, 0.275, indicator, {.max_triangles = most});
        std::printf("%zu triangles of %zu, |U - C| <= %g\n", result.surface.simplices.size(),
                    static_cast<std::size_t>(most), result.error_bound);
        picture.look(view++, ball);
        draw(picture, result.surface, true, [](std::size_t) { return sand; });
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
    const auto result = isosurface(grid, field, 0.275, criterion, indicator);
    // [region]
    // [budget_outside]
    const auto criterion_at = [&](double outside) {
        return fine_inside(region, indicator, outside, 0.0);
    };
    const TriangleBudget found =
        find_threshold(grid, field, 0.275, criterion_at, indicator, 45'000);
    const auto within = isosurface(grid, field, 0.275, criterion_at(found.threshold), indicator);
    // [budget_outside]
    Picture picture(380, 380, 2);
    int view = 0;
    for (const auto* surface : {&result.surface, &within.surface}) {
        picture.look(view++, ball);
        draw(picture, *surface, true, [](std::size_t) { return sand; });
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
    const auto open = isosurface(grid, field, 0.275, Unsaturated(two_sides), indicator);

    const Region side(grid, [](const Point& x) { return x[0] > 32; });
    const auto saturated = fine_inside(side, indicator, 0.1, 0.002);
    const auto closed = isosurface(grid, field, 0.275, saturated, indicator);
    // [insist]
    Picture picture(380, 380, 2);
    int view = 0;
    for (const auto* result : {&open, &closed}) {
        picture.look(view++, ball);
        draw(picture, result->surface, true, [](std::size_t) { return sand; });
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
        const auto result = isosurface(grid, field, 0.275, levels.deeper_than(deepest), indicator);
        picture.look(view++, ball);
        draw(picture, result.surface, true, [](std::size_t) { return sand; });
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

void derived_figure(const std::string& file) {
    // The flow of Arnold, Beltrami and Childress.
    const auto flow_at = [](const Point& x) {
        return Point{std::sin(3 * x[2]) + std::cos(3 * x[1]),
                     std::sin(3 * x[0]) + std::cos(3 * x[2]),
                     std::sin(3 * x[1]) + std::cos(3 * x[0])};
    };
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
        {"bucky_ball", bucky_figure},      {"isosurface", isosurface_figure},
        {"isoband", isoband_figure},       {"isosurface_series", series_figure},
        {"budget", budget_figure},         {"region", region_figure},
        {"criteria", criteria_figure},     {"levels", levels_figure},
        {"measures", measures_figure},     {"hanging_nodes", hanging_figure},
        {"derived_field", derived_figure}, {"families", families_figure}};
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
