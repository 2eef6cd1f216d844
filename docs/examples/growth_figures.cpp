// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Plots of the work against the size of the grid (paper, figure 8).
#include "growth_figures.hpp"

#include <cstdio>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "plot.hpp"
#include "scenes.hpp"

namespace figures {

namespace {

using Tetrahedra = LatticeBisection<3>;

}  // namespace

void isosurface_growth_figure(const std::string& file) {
    Curve all{"marching", {0.55, 0.55, 0.58}, {}, false};
    Curve slope{"their number^2/3", red, {}, false};
    std::vector<Curve> curves{
        {"0", ramp(0)}, {"0.00125", ramp(0.3)}, {"0.005", ramp(0.6)}, {"0.02", ramp(0.9)}};
    for (const int n : {9, 17, 33, 65, 129, 257}) {
        const Tetrahedra grid({.samples = {n, n, n}});
        const std::vector<float> samples = bucky_ball(n);
        const LatticeField field(grid, std::span<const float>(samples));
        const HierarchicalIndicator indicator(grid, field);
        const double count = 6 * std::pow(n - 1, 3);
        std::printf("%9.0f tetrahedra, visited", count);
        for (Curve& curve : curves) {
            const Threshold criterion(&indicator, std::stod(curve.name));
            const auto drawn =
                isosurface(grid, field, 0.275, under(criterion, indicator), {.elements = false});
            curve.points.push_back({count, static_cast<double>(drawn.counts.visited)});
            std::printf(" %7.0f", curve.points.back()[1]);
        }
        std::printf("\n");
        all.points.push_back({count, count});
        slope.points.push_back({count, 2 * std::pow(count, 2.0 / 3)});
    }
    curves.insert(curves.begin(), {all, slope});
    plot_logarithmic(file, "tetrahedra", "visited elements", curves);
}

void slice_growth_figure(const std::string& file) {
    Curve all{"all of them", {0.55, 0.55, 0.58}, {}, false};
    Curve slope{"their number^2/3", red, {}, false};
    Curve oblique{"oblique plane", ramp(0.2)};
    Curve level{"level plane", ramp(0.65)};
    for (const int n : {17, 33, 65, 129, 257}) {
        const Tetrahedra grid({.samples = {n, n, n}});
        const double m = (n - 1) / 2.0;
        const double count = 6 * std::pow(n - 1, 3);
        const auto visited = [&](const Point& normal) {
            const Plane cut({m, m, m + 0.3}, normal);
            const Slice drawn = slice(grid, ZeroField<Tetrahedra>{}, cut, {}, {.elements = false});
            return static_cast<double>(drawn.counts.visited);
        };
        oblique.points.push_back({count, visited({0.3, 0.5, 0.81})});
        level.points.push_back({count, visited({0, 0, 1})});
        all.points.push_back({count, count});
        slope.points.push_back({count, std::pow(count, 2.0 / 3)});
        std::printf("%9.0f tetrahedra, visited %7.0f and %7.0f\n", count, oblique.points.back()[1],
                    level.points.back()[1]);
    }
    plot_logarithmic(file, "tetrahedra", "visited elements", {all, slope, level, oblique});
}

}  // namespace figures
