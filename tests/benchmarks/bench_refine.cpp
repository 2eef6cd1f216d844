// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Speed of refinement with its closure at a sphere: leaves after the last level per second of that
// level, and of a step that changes nothing; p4est and AlbertaGrid on the same task beside it.
// Then a hierarchy of more than ten million tetrahedra: built, traversed, resident memory.
// One `name value` line per figure. --quick: shallower grids.
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

#ifdef NESTGRID_WITH_P4EST
#include "p4est_octree.hpp"
#endif
#ifdef NESTGRID_WITH_ALBERTA
#include "alberta_bisection.hpp"
#endif

#include <nestgrid/detail/erase.hpp>

#include "count_leaves.hpp"
#include "sample_grids.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

bool quick = false;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

void print(const std::string& name, double value) {
    std::printf("%s %.4g\n", name.c_str(), value);
    std::fflush(stdout);
}

template <class Grid>
void measure_family(const std::string& name, Grid start, int levels) {
    if (quick) levels -= std::max(1, levels / 6);
    double best = 1e30;
    double best_keep = 1e30;
    std::size_t leaves = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
        Grid grid = start;
        refine_at_sphere(grid, levels - 1);
        double begin = now();
        refine_at_sphere_once(grid, levels);
        best = std::min(best, now() - begin);
        begin = now();
        grid.adapt([](const Leaf&) { return Mark::keep; });
        best_keep = std::min(best_keep, now() - begin);
        leaves = grid.leaf_count();
    }
    print(name + "_leaves", static_cast<double>(leaves));
    print(name + "_million_leaves_per_second", static_cast<double>(leaves) / best / 1e6);
    print(name + "_unchanged_million_leaves_per_second",
          static_cast<double>(leaves) / best_keep / 1e6);
}

double resident_peak_gib() {
    std::ifstream status("/proc/self/status");
    std::string word;
    while (status >> word) {
        if (word == "VmHWM:") {
            double kib = 0;
            status >> kib;
            return kib / 1048576;
        }
    }
    return 0;
}

/// The sizes of the paper, adaptively refined.
template <class Grid>
void measure_ten_million(const std::string& name, Grid grid, int steps) {
    const std::size_t wanted = quick ? 1000000 : 10000000;
    const double begin = now();
    for (int level = 1; grid.leaf_count() < wanted; level += steps) {
        refine_at_sphere(grid, level);
    }
    print(name + "_leaves", static_cast<double>(grid.leaf_count()));
    print(name + "_build_seconds", now() - begin);
    const std::vector<float> values(grid.node_count(), 1);
    const NodeField<Grid, float> field(grid, std::span<const float>(values));
    const auto hierarchy = erase(grid, field);
    const engine::Walk<float> walk(hierarchy, {.keys = true, .positions = true});
    const double start = now();
    const auto leaves = static_cast<double>(count_leaves(walk));
    print(name + "_traversal_ns_per_leaf", (now() - start) * 1e9 / leaves);
    print(name + "_resident_peak_gib", resident_peak_gib());
}

}  // namespace

int main(int argc, char** argv) {
    quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    // First, so that the peak is its own.
    measure_ten_million("ten_million_tetrahedra", RedGreenSimplices<3>(tetrahedra(2)), 1);
    const std::vector<double> layer{1.0};
    measure_family("red_green_tetrahedra", RedGreenSimplices<3>(tetrahedra(1)), 7);
    measure_family("bisection_tetrahedra", BisectionGrid<3>(tetrahedra(1)), 21);
    measure_family("red_green_hexahedra", RedGreenGrid<3>(hexahedra(1)), 7);
    measure_family("octree_hexahedra", OctreeGrid<3>(hexahedra(1)), 7);
    measure_family("prism", PrismGrid(extrude(triangles(1), layer)), 6);
    measure_family("bisection_triangles", BisectionGrid<2>(triangles(1)), 26);
    measure_family("red_green_triangles", RedGreenSimplices<2>(triangles(1)), 14);
#ifdef NESTGRID_WITH_P4EST
    double best = 1e30;
    double best_with_nodes = 1e30;
    std::size_t leaves = 0;
    for (int repetition = 0; repetition < 3; ++repetition) {
        const P4estFigures p4est = refine_p4est_at_sphere(quick ? 6 : 7);
        best = std::min(best, p4est.seconds);
        best_with_nodes = std::min(best_with_nodes, p4est.seconds + p4est.node_seconds);
        leaves = p4est.leaves;
    }
    print("p4est_leaves", static_cast<double>(leaves));
    print("p4est_million_leaves_per_second", static_cast<double>(leaves) / best / 1e6);
    print("p4est_with_nodes_million_leaves_per_second",
          static_cast<double>(leaves) / best_with_nodes / 1e6);
#endif
#ifdef NESTGRID_WITH_ALBERTA
    const AlbertaFigures alberta = refine_alberta_at_sphere(quick ? 15 : 21);
    print("alberta_leaves", static_cast<double>(alberta.leaves));
    print("alberta_million_leaves_per_second",
          static_cast<double>(alberta.leaves) / alberta.seconds / 1e6);
#endif
    return 0;
}
