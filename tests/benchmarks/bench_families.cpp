// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a visited element costs on every family of hierarchies: the implicit octree of the bucky
// ball's samples, beside a recursion written by hand for it, and stored hierarchies refined at a
// sphere. One "name value" line per figure; --quick takes smaller ones.
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>

#include "bucky_samples.hpp"
#include "handwritten_octree.hpp"
#include "sample_grids.hpp"

namespace {

using namespace nestgrid_test;

template <int n>
void measure_octree(std::size_t rounds) {
    Bucky<n> bucky;
    using Hexahedra = LatticeOctree<3>;
    const Hexahedra grid({.samples = {n, n, n}});
    const LatticeField field(grid, std::span<const float>(bucky.samples));
    bucky.indicator = HierarchicalIndicator(grid, field);
    Contest before(rounds);
    before.add("preroll", [&] { HierarchicalIndicator(grid, field); });
    before.run();
    Contest::print_figure("implicit_octree_preroll_ns_per_node",
                          before.time("preroll") * 1e6 / static_cast<double>(grid.node_count()));
    const auto nodes = bucky.handwritten_nodes();
    for (const float threshold : bucky_thresholds) {
        HandwrittenOctree<n> recursion(nodes.data(), bucky_isovalue, threshold, bucky.soup.data());
        TraversalCounts counts;
        Contest contest(rounds);
        contest.add("handwritten", [&] {
            recursion =
                HandwrittenOctree<n>(nodes.data(), bucky_isovalue, threshold, bucky.soup.data());
            recursion.run();
        });
        contest.add("ours", [&] { bucky.draw_soup(grid, field, threshold, &counts); });
        contest.run();
        const auto print = [&](const char* name, double value) {
            Contest::print_figure(at_threshold(name, threshold), value);
        };
        print("implicit_octree_visited", static_cast<double>(counts.visited));
        print("handwritten_octree_visited", static_cast<double>(recursion.visited()));
        print("implicit_octree_ns_per_visited",
              contest.time("ours") * 1e6 / static_cast<double>(counts.visited));
        print("implicit_octree_over_handwritten",
              contest.time("ours") / contest.time("handwritten"));
    }
}

template <class Grid>
void measure_family(const std::string& name, Grid grid, int levels, std::size_t rounds) {
    refine_at_sphere(grid, levels);
    std::vector<double> values;
    for (const Point& x : grid.node_positions()) values.push_back(to_sphere(x, 3));
    const NodeField<Grid, double> field(grid, values);
    IsosurfaceSeries series(grid, field);
    TraversalCounts counts;
    Contest contest(rounds);
    contest.add("preroll", [&] { HierarchicalIndicator(grid, field); });
    contest.add("draw", [&] { counts = series.draw(0, {}, {.elements = false}).counts; });
    contest.run();
    Contest::print_figure(name + "_leaves", static_cast<double>(grid.leaf_count()));
    Contest::print_figure(name + "_visited", static_cast<double>(counts.visited));
    Contest::print_figure(name + "_ns_per_visited",
                          contest.time("draw") * 1e6 / static_cast<double>(counts.visited));
    Contest::print_figure(name + "_preroll_ns_per_node",
                          contest.time("preroll") * 1e6 / static_cast<double>(values.size()));
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = is_quick(argc, argv);
    const std::size_t rounds = quick ? 3 : 9;
    quick ? measure_octree<33>(rounds) : measure_octree<129>(rounds);
    const int less = quick ? 1 : 0;
    measure_family("bisection_tetrahedra", BisectionGrid<3>(tetrahedra(1)), 18 - 3 * less, rounds);
    measure_family("red_green_tetrahedra", RedGreenSimplices<3>(tetrahedra(1)), 6 - less, rounds);
    measure_family("red_green_hexahedra", RedGreenGrid<3>(hexahedra(1)), 6 - less, rounds);
    measure_family("octree_hexahedra", OctreeGrid<3>(hexahedra(1)), 6 - less, rounds);
    const std::vector<double> layer{1.0};
    measure_family("prism", PrismGrid(extrude(triangles(1), layer)), 5 - less, rounds);
    return 0;
}
