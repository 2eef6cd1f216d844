// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an updated preroll costs beside a new one, after values have changed in a small ball of the
// bucky ball: on octrees of growing size, over samples and refined at a sphere. One "name value"
// line per figure; --quick takes smaller ones.
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/indicator.hpp>

#include "bucky_ball.hpp"
#include "contest.hpp"
#include "sample_grids.hpp"

namespace {

using namespace nestgrid;

/// Updates and makes a preroll in turns.
/// \param make make() is the field
template <class Grid, class Make>
void measure(const std::string& name, const Grid& grid, const Make& make, const ChangedBox& box,
             std::size_t rounds) {
    const auto field = make();
    HierarchicalIndicator indicator(grid, field);
    Contest contest(rounds);
    contest.add("update", [&] { indicator.update(grid, field, box); });
    contest.add("new", [&] { HierarchicalIndicator fresh(grid, field); });
    contest.run();
    Contest::print_figure(name + "_update_us", contest.time("update") * 1e3);
    Contest::print_figure(name + "_new_us", contest.time("new") * 1e3);
    Contest::print_figure(name + "_update_to_new", contest.time("update") / contest.time("new"));
}

}  // namespace

int main(int argc, char** argv) {
    const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
    const std::size_t rounds = quick ? 1 : 5;
    for (const int n : quick ? std::vector<int>{17} : std::vector<int>{33, 65, 129, 257}) {
        const LatticeOctree<3> grid({.samples = {n, n, n}});
        const std::vector<float> samples = bucky_ball(n);
        const double at = 0.37 * (n - 1);
        const ChangedBox box{{at, at, at}, {at + 3, at + 3, at + 3}};
        measure(
            "samples_" + std::to_string(n), grid,
            [&] { return LatticeField(grid, std::span<const float>(samples)); }, box, rounds);
    }
    nestgrid_test::BalancedOctree::Grid tree = nestgrid_test::BalancedOctree::grids()[0];
    for (int level = 1; level <= (quick ? 4 : 8); ++level) {
        nestgrid_test::refine_at_sphere_once(tree, level);
        if (level < (quick ? 4 : 5)) continue;
        const std::vector<double> values = nestgrid_test::sample_nodes(
            tree, [](const Point& x) { return nestgrid_test::to_sphere(x, 3); });
        const double h = std::ldexp(1.0, -level);
        const Point x{0.85 - 2 * h, 0.5, 0.5};
        const ChangedBox box{x, x + Point{3 * h, 3 * h, 3 * h}};
        measure(
            "octree_of_" + std::to_string(tree.leaf_count()), tree,
            [&] { return NodeField<nestgrid_test::BalancedOctree::Grid, double>(tree, values); },
            box, rounds);
    }
    return 0;
}
