// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "discontinuous_figure.hpp"

#include <cstdio>

#include <nestgrid/algorithms/cell_data.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/shading.hpp>

#include "scenes.hpp"

namespace figures {

namespace {

using Grid = OctreeGrid<2>;

/// A density that jumps at the rim of a wave, as finite volume methods compute it.
double density(const Point& x) {
    const double r = std::hypot(x[0] + 0.2, x[1] + 0.15);
    return r < 0.75 ? 0.35 + 0.45 * std::exp(-4 * std::pow(r - 0.7, 2)) : 0.1;
}

void paint(Picture& picture, int view, const Surface<3>& surface) {
    picture.look(view, plane);
    draw(picture, surface, true, [&](std::size_t t) {
        double sum = 0;
        for (const std::uint32_t v : surface.simplices[t]) sum += surface.attributes[v];
        return ramp(sum / 3 / 0.8);
    });
}

}  // namespace

void discontinuous_figure(const std::string& file) {
    Grid grid(box(2));
    refine(grid, density, 5, 2, 0.05);
    const std::vector<Point> corners = grid.node_positions();
    Picture picture(300, 300, 3);
    // [discontinuous]
    const auto value = [&](const Grid::Element& cell) {  // one number for each leaf
        return density(0.5 * (corners[cell.corner[0]] + corners[cell.corner[3]]));
    };
    const DiscontinuousData data(grid, value);
    const ElementDeviations deviations(data);
    const auto all = shading(data);
    const auto some = shading(data, {.threshold = 0.03, .deviations = &deviations});
    // [discontinuous]
    paint(picture, 0, all.surface);
    paint(picture, 1, some.surface);
    const CellAverages means(grid, value);
    const auto continuous = shading(grid, means, {.threshold = 0.03});
    paint(picture, 2, continuous.surface);
    std::printf("%zu cells, %zu that stop, %zu of means at nodes\n", all.surface.level_of.size(),
                some.surface.level_of.size(), continuous.surface.level_of.size());
    picture.write(file);
}

}  // namespace figures
