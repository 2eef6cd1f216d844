// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "time_figure.hpp"

#include <cmath>
#include <cstdio>

#include <nestgrid/adapters/union.hpp>
#include <nestgrid/algorithms/between.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/shading.hpp>

#include "scenes.hpp"

namespace figures {

namespace {

/// A hill on one side of the middle of the square.
double moving_hill(const Point& x, double side) {
    const double r = std::hypot(x[0] - 0.25 * side, x[1] - 0.1 * side);
    return std::exp(-7 * r * r) + 0.15 * std::exp(-150 * std::pow(r - 0.5, 2));
}

}  // namespace

void time_figure(const std::string& file) {
    const auto left = [](const Point& x) { return moving_hill(x, -1); };
    const auto right = [](const Point& x) { return moving_hill(x, 1); };
    OctreeGrid<2> first(box(2));
    OctreeGrid<2> second(box(2));
    refine(first, left, 3, 3, 0.008);
    refine(second, right, 3, 3, 0.008);
    const std::vector<double> first_values = values(first, left);
    const std::vector<double> second_values = values(second, right);
    const NodeField<OctreeGrid<2>, double> first_field(first, first_values);
    const NodeField<OctreeGrid<2>, double> second_field(second, second_values);
    const Union both(first, first_field, second, second_field);
    const UnionFrame a = both.frame(0);
    const UnionFrame b = both.frame(1);
    const HierarchicalIndicator of_a(both, a);
    const HierarchicalIndicator of_b(both, b);
    Picture picture(230, 230, 5);
    for (int view = 0; view < 5; ++view) {
        const auto weights = linear_weights(std::array{0.0, 4.0}, view);
        const KeyFrames indicator({&of_a, &of_b}, weights);
        const Between field({&a, &b}, weights);
        const Threshold s(&indicator, 0.01);
        const Surface<3> grid = shading(both, field, under(s, indicator)).surface;
        picture.look(view, plane);
        draw(picture, grid, true, [&](std::size_t t) {
            double sum = 0;
            for (const std::uint32_t v : grid.simplices[t]) sum += grid.attributes[v];
            return ramp(sum / 3);
        });
        for (const double value : {0.25, 0.5, 0.75}) {
            draw(picture, isosurface(both, field, value, under(s, indicator)).surface, red, 2);
        }
        std::printf("t %.2f: %zu triangles\n", view / 4.0, grid.simplices.size());
    }
    picture.write(file);
}

}  // namespace figures
