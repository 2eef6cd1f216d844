// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the prerolls of indicators cost beside that of offsets, where all of them walk element by
// element, and how many elements are visited at their thresholds. One "name value" line per figure;
// --quick takes smaller grids.
#include <nestgrid/algorithms/geometry_indicator.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include "bucky_samples.hpp"
#include "sample_grids.hpp"

namespace {

using namespace nestgrid_test;

/// A lattice that tells no star rows.
class WalkedLattice : private LatticeBisection<3> {
    using Base = LatticeBisection<3>;

public:
    using typename Base::Element;
    static constexpr int dimension = 3;
    static constexpr int max_corners = Base::max_corners;
    static constexpr int max_new_nodes = Base::max_new_nodes;
    static constexpr int max_children = Base::max_children;
    using Base::Base;
    using Base::boundary_faces;
    using Base::children;
    using Base::coarse;
    using Base::coarse_count;
    using Base::conforming;
    using Base::corner_keys;
    using Base::corner_positions;
    using Base::new_keys;
    using Base::node_count;
    using Base::outside;
    using Base::split;

    const Base& lattice() const { return *this; }
};

double gyroid(const Point& x) {
    const auto [a, b, c] = 9.0 * x;
    return std::sin(a) * std::cos(b) + std::sin(b) * std::cos(c) + std::sin(c) * std::cos(a);
}

template <class Grid, class Field>
void measure(const std::string& name, const Grid& grid, const Field& field, double nodes,
             double isovalue, std::size_t rounds) {
    const auto h = erase(grid, field);
    const HierarchicalIndicator offsets(h);
    const double range = offsets.greatest() - offsets.least();
    const double tau = 0x1p-20 * range;
    Contest contest(rounds, Clock::processor);
    contest.add("offset", [&] { HierarchicalIndicator{h}; });
    contest.add("deviation", [&] { HierarchicalIndicator{h, NodeError::deviation}; });
    contest.add("visual", [&] { visual_indicator(h, {.tau = tau}); });
    contest.add("visual_finds_tau", [&] { visual_indicator(h); });
    contest.add("numerical", [&] { numerical_indicator(h); });
    contest.add("wavelet", [&] { wavelet_indicator(h); });
    contest.add("norm", [&] { norm_indicator(h); });
    contest.add("geometry", [&] { geometry_indicator(h); });
    contest.run();
    Contest::print_figure(name + "_offset_ns_per_node", contest.time("offset") * 1e6 / nodes);
    for (const char* other :
         {"deviation", "visual", "visual_finds_tau", "numerical", "wavelet", "norm", "geometry"}) {
        Contest::print_figure(name + "_" + other + "_over_offset",
                              contest.time(other) / contest.time("offset"));
    }
    const auto print_visited = [&](const char* indicator, const char* at, const Criterion& s) {
        const auto result = isosurface<3>(h, isovalue, under(s, offsets), {.elements = false});
        Contest::print_figure(name + "_" + indicator + "_" + at + "_visited",
                              static_cast<double>(result.counts.visited));
    };
    print_visited("any", "at_0", Exact());
    const SweptIndicator visual = visual_indicator(h, {.tau = tau});
    const SweptIndicator numerical = numerical_indicator(h);
    print_visited("offset", "at_0.5%", Threshold(&offsets, 0.005 * range));
    print_visited("offset", "at_2%", Threshold(&offsets, 0.02 * range));
    const HierarchicalIndicator deviations(h, NodeError::deviation);
    print_visited("deviation", "at_0.5%", Threshold(&deviations, 0.005 * range));
    print_visited("deviation", "at_2%", Threshold(&deviations, 0.02 * range));
    print_visited("visual", "at_0.25", Threshold(&visual, 0.25));
    print_visited("visual", "at_0.5", Threshold(&visual, 0.5));
    print_visited("numerical", "at_4%", Threshold(&numerical, 0.04 * range));
    print_visited("numerical", "at_16%", Threshold(&numerical, 0.16 * range));
}

template <class Grid>
void measure_stored(const std::string& name, Grid grid, int levels, std::size_t rounds) {
    for (int i = 0; i < levels; ++i) grid.refine_uniformly();
    const auto values = sample_nodes(grid, gyroid);
    const NodeField<Grid, double> field(grid, values);
    measure(name, grid, field, static_cast<double>(grid.used_node_count()), 0.3, rounds);
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = is_quick(argc, argv);
    const std::size_t rounds = quick ? 1 : 5;
    const int less = quick ? 2 : 0;
    measure_stored("octree", OctreeGrid<3>(hexahedra(1)), 6 - less, rounds);
    measure_stored("shaken_octree", OctreeGrid<3>(shaken(hexahedra(2), 9, 0.05)), 5 - less, rounds);
    measure_stored("bisection", BisectionGrid<3>(tetrahedra(1)), 18 - 3 * less, rounds);
    measure_stored("red_green", RedGreenSimplices<3>(tetrahedra(1)), 6 - less, rounds);
    measure_stored("prism", PrismGrid(extrude(triangles(2), std::vector<double>{1.0})), 5 - less,
                   rounds);
    const int n = quick ? 17 : 65;
    const WalkedLattice lattice({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(lattice.lattice(), std::span<const float>(samples));
    measure("lattice", lattice, field, static_cast<double>(samples.size()), bucky_isovalue, rounds);
    return 0;
}
