// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a probed point costs on the bucky ball's samples, as an octree and as a bisection: random
// points, and points on a line. One "name value" line per figure; --quick takes smaller ones.
#include <random>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/probe_line.hpp>

#include "bucky_ball.hpp"
#include "contest.hpp"

namespace {

using namespace nestgrid;

template <class Grid, class Field>
void measure(const std::string& grid_name, const Grid& grid, const Field& field, double length,
             std::size_t count, std::size_t rounds) {
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion(&indicator, 0.02);
    std::mt19937 random(1);
    std::vector<Point> points(count);
    for (Point& x : points) {
        for (double& at : x) at = length * static_cast<double>(random()) / 4294967296.0;
    }
    const Point end{length, 0.8 * length, 0.6 * length};
    TraversalCounts counts;
    Contest contest(rounds);
    contest.add("random", [&] { counts = probe(grid, field, points).counts; });
    contest.add("random_at_0.02", [&] { probe(grid, field, points, under(criterion, indicator)); });
    contest.add("line", [&] { probe_line(grid, field, {0, 0, 0}, end, count); });
    contest.add("one", [&] { probe_point(grid, field, points[0]); });
    contest.run();
    const std::string name = grid_name + "_of_" + std::to_string(count);
    const auto per_point = [&](const char* what) {
        return contest.time(what) * 1e6 / static_cast<double>(count);
    };
    for (const char* what : {"random", "random_at_0.02", "line"}) {
        Contest::print_figure(name + "_" + what + "_ns_per_point", per_point(what));
    }
    Contest::print_figure(name + "_calls_per_point",
                          static_cast<double>(counts.calls) / static_cast<double>(count));
    Contest::print_figure(grid_name + "_one_point_ns", contest.time("one") * 1e6);
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
    const int n = quick ? 33 : 129;
    const std::vector<float> samples = bucky_ball(n);
    const LatticeOctree<3> octree({.samples = {n, n, n}});
    const LatticeBisection<3> bisection({.samples = {n, n, n}});
    const std::span<const float> values(samples);
    for (const std::size_t count : quick ? std::vector<std::size_t>{1000}
                                         : std::vector<std::size_t>{1000, 100'000, 1'000'000}) {
        measure("octree", octree, LatticeField(octree, values), n - 1, count, quick ? 1 : 3);
        measure("bisection", bisection, LatticeField(bisection, values), n - 1, count,
                quick ? 1 : 3);
    }
    return 0;
}
