// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "colour_figure.hpp"

#include <cstdio>

#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "scenes.hpp"

namespace figures {

namespace {

double waves(const Point& x) {
    return std::sin(5 * x[0] - 1) * std::cos(4 * x[1]) * std::cos(3 * x[2]);
}

/// Draws a triangle in bands of colour, which are linear on it, as a renderer would.
void draw_bands(Picture& picture, const std::array<Point, 3>& x, const std::array<double, 3>& u,
                int halvings) {
    if (halvings == 0) {
        const double mean = (u[0] + u[1] + u[2]) / 3;
        picture.triangle(x, ramp((std::floor(10 * mean) + 6.5) / 12), false);
        return;
    }
    const auto middle = [](const auto& at, std::size_t i) {
        return 0.5 * (at[i] + at[(i + 1) % 3]);
    };
    const std::array<Point, 3> y{middle(x, 0), middle(x, 1), middle(x, 2)};
    const std::array<double, 3> v{middle(u, 0), middle(u, 1), middle(u, 2)};
    draw_bands(picture, y, v, halvings - 1);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t before = (i + 2) % 3;
        draw_bands(picture, {x[i], y[i], y[before]}, {u[i], v[i], v[before]}, halvings - 1);
    }
}

void draw_colours(Picture& picture, const Surface<3>& surface, int halvings) {
    for (const auto& [a, b, c] : surface.simplices) {
        const std::array<Point, 3> x{surface.vertices[a], surface.vertices[b], surface.vertices[c]};
        const std::array<double, 3> u{surface.attributes[a], surface.attributes[b],
                                      surface.attributes[c]};
        draw_bands(picture, x, u, halvings);
    }
}

}  // namespace

void refine_colours_figure(const std::string& file) {
    OctreeGrid<3> grid(box(3));
    for (int step = 0; step < 2; ++step) grid.refine_uniformly();
    const std::vector<double> u = values(grid, waves);
    const NodeField<OctreeGrid<3>, double> field(grid, u);
    const Plane cut({0, 0, 0.1}, {0.3, 0.5, 0.81});
    Surface<3> surface = slice(grid, field, cut).surface;
    Picture picture(400, 400, 2);
    const View view{.towards_eye = {-0.3, -0.5, -0.81}, .up = {0, 0, 1}, .height = 3.3};
    picture.look(0, view);
    draw_colours(picture, surface, 6);
    std::printf("%zu triangles", surface.simplices.size());
    refine_colours(surface, {grid, field}, 0.02);
    std::printf(", %zu with refined colours\n", surface.simplices.size());
    picture.look(1, view);
    draw_colours(picture, surface, 3);
    picture.write(file);
}

}  // namespace figures
