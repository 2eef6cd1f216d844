// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Figures of lenses, and of what moves with epsilon and with a lens.
#include "lens_figures.hpp"

#include <cstdio>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "hausdorff.hpp"
#include "plot.hpp"
#include "scenes.hpp"

namespace figures {

void lens_figure(const std::string& file) {
    const Bucky bucky;
    const auto& grid = bucky.grid;
    const auto& field = bucky.field;
    const HierarchicalIndicator indicator(grid, field);
    Picture picture(300, 300, 3);
    int view = 0;
    // [lens]
    const Plane middle({0, 0, 32}, {0, 0, 1});
    const SweptIndicator size = mesh_size(grid, {.slope = 0.5});  // once for all lenses
    for (const Point& centre : {Point{16, 24, 32}, Point{28, 36, 32}, Point{44, 44, 32}}) {
        const Lens lens(&size, Ball{centre, 9}, {.finest = 2});
        const Slice result = slice(grid, field, middle, under(lens, indicator));
        // [lens]
        picture.look(view++, {.centre = {32, 32, 32}, .height = 66});
        const Surface<3>& s = result.surface;
        draw(picture, s, true, [&](std::size_t t) {
            double sum = 0;
            for (const std::uint32_t v : s.simplices[t]) sum += s.attributes[v];
            return ramp(sum / 3);
        });
        draw_circle(picture, centre + Point{0, 0, 1}, 9);
        std::printf("%zu triangles, |U - colour| <= %g\n", s.simplices.size(), result.error_bound);
    }
    picture.write(file);
}

namespace {

/// A sphere in the cube between -1 and 1, through no node.
double off_centre(const Point& x) { return norm(x - Point{0.11, 0.05, -0.07}) - 0.73; }

/// A gyroid, whose gradient has about the length 1.
double wide_gyroid(const Point& x) {
    const auto [a, b, c] = 2.0 * x + Point{0.3, 0.7, 1.1};
    return 0.5 *
           (std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) + std::sin(c) * std::cos(a));
}

/// The greatest change of the projection at any node, over the change of the threshold: of epsilon
/// and of the place of a lens.
struct Moduli {
    double of_epsilon = 0;
    double of_place = 0;
};

Moduli greatest_moduli(const OctreeGrid<3>& grid, double factor) {
    const std::vector<double> u = values(grid, off_centre);
    const NodeField<OctreeGrid<3>, double> field(grid, u);
    const double slope = 0.02;
    const HierarchicalIndicator indicator(grid, field, Spread{.factor = factor, .slope = slope});
    const HierarchicalIndicator without_slope(grid, field, Spread{.factor = factor});
    const std::vector<Point> nodes = grid.node_positions();
    const auto move = [&](const Criterion& a, const Criterion& b) {
        const auto before = probe(grid, field, nodes, under(a, indicator)).values;
        const auto after = probe(grid, field, nodes, under(b, indicator)).values;
        double greatest = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            greatest = std::max(greatest, std::abs(after[i] - before[i]));
        }
        return greatest;
    };
    Moduli greatest;
    for (double epsilon = 0.0005; epsilon < 0.03; epsilon *= 1.02) {
        const double step = 0.001 * epsilon;
        const double moved = move(Blended(&without_slope, epsilon, factor),
                                  Blended(&without_slope, epsilon + step, factor));
        greatest.of_epsilon = std::max(greatest.of_epsilon, moved / step);
    }
    for (double place = -0.5; place < 0.5; place += 0.02) {
        const double step = 0.001;
        const auto lens_at = [&](double x) {
            const LensOptions options{.finest = 0.001, .blend = factor};
            return Lens(&indicator, Ball{{x, 0.3 * x, 0.1}, 0.2}, options);
        };
        const double way = step * std::hypot(1, 0.3);
        const double moved = move(lens_at(place), lens_at(place + step));
        greatest.of_place = std::max(greatest.of_place, moved / (slope * way));
    }
    return greatest;
}

/// The greatest distance of two surfaces whose thresholds differ by a relative step.
template <class Grid>
double greatest_step(const Grid& grid, double factor, double relative) {
    const std::vector<double> u = values(grid, wide_gyroid);
    const NodeField<Grid, double> field(grid, u);
    // [blended]
    const HierarchicalIndicator indicator(grid, field, Spread{.factor = factor});
    const auto at = [&](double epsilon) {
        return isosurface(grid, field, 0.1, under(Blended(&indicator, epsilon, factor), indicator))
            .surface;
    };
    // [blended]
    double greatest = 0;
    auto before = at(0.02);
    for (double epsilon = 0.02; epsilon < 0.08; epsilon *= 1 + relative) {
        auto after = at(epsilon * (1 + relative));
        greatest = std::max(greatest, hausdorff_distance(before, after));
        before = std::move(after);
    }
    return greatest;
}

}  // namespace

void blended_figure(const std::string& file) {
    OctreeGrid<3> hexahedra(box(3));
    BisectionGrid<3> tetrahedra(six_tetrahedra());
    for (int level = 0; level < 3; ++level) {
        hexahedra.refine_uniformly();
        for (int step = 0; step < 3; ++step) tetrahedra.refine_uniformly();
    }
    OctreeGrid<3> finer = hexahedra;
    finer.refine_uniformly();
    std::printf("factor  constant  of epsilon  of the place of a lens\n");
    for (const double c : {1.125, 1.25, 1.5, 2.0, 3.0, 4.0}) {
        const Moduli measured = greatest_moduli(finer, c);
        std::printf("%6.3f %9.2f %11.2f %11.2f\n", c, c * c / (c - 1), measured.of_epsilon,
                    measured.of_place);
    }
    Curve jumps{"hexahedra", {0.95, 0.65, 0.6}};
    Curve jumps_less{"tetrahedra", {0.6, 0.75, 0.95}};
    Curve steps{"hexahedra, 1.5", red};
    Curve moves{"tetrahedra, 1.5", blue};
    std::printf("step    tetrahedra: threshold  blended  hexahedra: threshold  blended\n");
    for (const double step : {0.005, 0.01, 0.02, 0.04, 0.08, 0.16}) {
        jumps_less.points.push_back({step, greatest_step(tetrahedra, 1, step)});
        moves.points.push_back({step, greatest_step(tetrahedra, 1.5, step)});
        jumps.points.push_back({step, greatest_step(hexahedra, 1, step)});
        steps.points.push_back({step, greatest_step(hexahedra, 1.5, step)});
        std::printf("%5.1f %% %21.5f %8.5f %21.5f %8.5f\n", 100 * step, jumps_less.points.back()[1],
                    moves.points.back()[1], jumps.points.back()[1], steps.points.back()[1]);
    }
    plot_logarithmic(file, "relative change of the threshold", "distance of the surfaces",
                     {jumps_less, jumps, steps, moves});
}

}  // namespace figures
