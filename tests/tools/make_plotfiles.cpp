// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Small plotfiles for the tests of the program, in the folder of the argument: three of a ball that
// moves, on one grid of three levels, one on another grid, one of fewer cells, one in the plane,
// and two in which some leaves hold no number, or an infinite one.
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "amrex_plotfiles.hpp"

using namespace nestgrid_test;

namespace {

/// The unit cube or square, finer by two and by four around the middle.
template <int dim>
Blocks<dim> three_levels(int cells, int margin) {
    Blocks<dim> blocks;
    BlockBox<dim> box;
    int ratio = 1;
    for (const int next : {1, 2, 4}) {
        ratio *= next;
        for (std::size_t d = 0; d < dim; ++d) {
            const int left_out = (next == 1 ? 0 : next == 2 ? 1 : 2) * margin;
            box.lower[d] = left_out * ratio;
            box.upper[d] = (cells - left_out) * ratio - 1;
            blocks.spacing[d] = 1.0 / cells;
        }
        BlockLevel<dim> level;
        level.ratio.fill(next);
        BlockBox<dim> half = box;
        half.upper[0] = (box.lower[0] + box.upper[0] + 1) / 2 - 1;
        level.boxes.push_back(half);
        half.lower[0] = half.upper[0] + 1;
        half.upper[0] = box.upper[0];
        level.boxes.push_back(half);
        blocks.levels.push_back(level);
    }
    return blocks;
}

/// The distance from a sphere that moves, and a place.
std::function<double(const Point&, int)> ball(double time, int dim) {
    return [time, dim](const Point& x, int field) {
        if (field == 1) return x[0];
        const Point centre{0.45 + 0.1 * time, 0.5, dim == 3 ? 0.5 : 0};
        return norm(x - centre) - 0.3;
    };
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: make_plotfiles FOLDER\n");
        return 1;
    }
    const std::filesystem::path folder(argv[1]);
    const std::vector<std::string> fields{"distance", "place"};
    const Blocks<3> blocks = three_levels<3>(16, 2);
    for (const int step : {0, 10, 20}) {
        char name[16];
        std::snprintf(name, sizeof name, "plt%05d", step);
        write_plotfile<3, double>(folder / name, blocks, fields, ball(0.1 * step, 3), 0.1 * step);
    }
    write_plotfile<3, double>(folder / "other", three_levels<3>(16, 3), fields, ball(0, 3), 1);
    const auto broken = [](double number) {
        return [=](const Point& x, int field) {
            const double value = ball(0, 3)(x, field);
            return field == 0 && norm(x - Point{0.75, 0.5, 0.5}) < 0.1 ? number : value;
        };
    };
    write_plotfile<3, double>(folder / "holed", blocks, fields, broken(NAN));
    write_plotfile<3, double>(folder / "infinite", blocks, fields, broken(INFINITY));
    // A cylinder along z is no part of the domain; what is in it is no distance.
    const auto around_body = [](const Point& x, int field) {
        const bool is_inside = std::hypot(x[0] - 0.75, x[1] - 0.5) < 0.1;
        if (field == 2) return is_inside ? 0.0 : 1.0;
        return is_inside ? -1e9 : ball(0, 3)(x, field);
    };
    write_plotfile<3, double>(folder / "around_body", blocks, {"distance", "place", "vfrac"},
                              around_body, 0, {.least_fraction = 1e-6});
    write_plotfile<3, double>(folder / "small", three_levels<3>(8, 1), fields, ball(0, 3));
    write_plotfile<2, float>(folder / "plane", three_levels<2>(16, 2), fields, ball(0, 2), 0,
                             {.ghosts = 1});
    return 0;
}
