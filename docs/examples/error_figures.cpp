// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "error_figures.hpp"

#include <cstdio>

#include <nestgrid/adapters/bisection_grid.hpp>
#include <nestgrid/algorithms/collapse.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/measured_error.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/shading.hpp>

#include "scenes.hpp"

namespace figures {

namespace {

constexpr double isovalue = 0.275;
constexpr Colour white{1, 1, 1};

/// The surface of the bucky ball within an error, and what is left of it after collapses.
class WithinError {
public:
    Surface<3> draw(double error) const {
        const Threshold s(&cuts_, error);
        return isosurface(bucky.grid, bucky.field, isovalue, under(s, deviations_)).surface;
    }
    Surface<3> collapsed(double error) const {
        Surface<3> surface = draw(collapse_start * error);
        collapse(surface, erase(bucky.grid, bucky.field), isovalue, deviations_, {.error = error});
        return surface;
    }

    const Bucky bucky{};

private:
    HierarchicalIndicator deviations_{bucky.grid, bucky.field, NodeError::deviation};
    SweptIndicator cuts_ =
        cut_deviations({bucky.grid, bucky.field}, std::span(&isovalue, 1), deviations_);
};

double swell(const Point& x) {
    return std::sin(3.1 * x[0] + 0.4) + std::cos(2.7 * x[1] - 0.3) +
           0.25 * std::sin(9 * x[0] * x[1]);
}

}  // namespace

void error_asked_figure(const std::string& file) {
    const WithinError within;
    Picture picture(280, 280, 3);
    int view = 0;
    for (const double error : {0.02, 0.05, 0.15}) {
        const Surface<3> surface = within.collapsed(error);
        draw_ball(picture, view++, surface);
        std::printf("error %g: %zu triangles, %zu of them left\n", error,
                    within.draw(error).simplices.size(), surface.simplices.size());
    }
    picture.write(file);
}

void error_kept_figure(const std::string& file) {
    BisectionGrid<2> grid(two_triangles());
    for (int step = 0; step < 12; ++step) grid.refine_uniformly();
    const std::vector<double> u = values(grid, swell);
    const NodeField<BisectionGrid<2>, double> field(grid, u);
    const HierarchicalIndicator deviations(grid, field, NodeError::deviation);
    const std::array level{0.3};
    const SweptIndicator cuts = cut_deviations({grid, field}, level, deviations);
    constexpr double error = 0.15;
    const Exact all;
    const auto data = shading(grid, field, under(all, deviations)).surface;
    const auto line = isosurface(grid, field, level[0], under(Threshold(&cuts, error), deviations));
    const auto whole = isosurface(grid, field, level[0], under(all, deviations));
    Picture picture(480, 480, 1);
    picture.look(0, plane);
    draw(picture, data, false, [&](std::size_t t) {
        double sum = 0;
        for (const std::uint32_t v : data.simplices[t]) sum += data.attributes[v];
        return std::abs(sum / 3 - level[0]) <= error ? sand : white;
    });
    for (const double end : {level[0] - error, level[0] + error}) {
        draw(picture, isosurface(grid, field, end, under(all, deviations)).surface, grey, 1.5);
    }
    draw(picture, whole.surface, blue, 2);
    draw(picture, line.surface, red, 3);
    std::printf("%zu segments of %zu, within %g of %g\n", line.surface.simplices.size(),
                whole.surface.simplices.size(), line.surface_error, error);
    picture.write(file);
}

void error_told_figure(const std::string& file) {
    constexpr double error = 0.05;
    const WithinError within;
    const Bucky& bucky = within.bucky;
    const Surface<3> surface = within.collapsed(error);
    const Surface<3> whole = isosurface(bucky.grid, bucky.field, isovalue).surface;
    const MeasuredError told = measure_error({bucky.grid, bucky.field}, surface, whole, isovalue);
    std::vector<Point> centres;
    for (const auto& [a, b, c] : surface.simplices) {
        const auto& x = surface.vertices;
        centres.push_back((1.0 / 3) * (x[a] + x[b] + x[c]));
    }
    const ProbeResult data = probe(bucky.grid, bucky.field, centres);
    Picture picture(480, 480, 1);
    picture.look(0, ball);
    draw(picture, surface, true,
         [&](std::size_t t) { return ramp(std::abs(data.values[t] - isovalue) / error); });
    std::printf(
        "%zu triangles: asked %g, found %.4f at most and %.4f in the mean (rms), %.2f samples "
        "off and %.2f back\n",
        surface.simplices.size(), error, told.value.greatest, told.value.rms,
        told.distance.greatest, told.back.greatest);
    picture.write(file);
}

}  // namespace figures
