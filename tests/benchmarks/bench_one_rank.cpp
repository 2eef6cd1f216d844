// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface drawn as programs on many ranks draw it, on one, and as programs without ranks do:
// count_instructions.py runs both under callgrind, and compares the instructions of each step.
//     bench_one_rank alone|ranks [leaves]
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "cut_grid.hpp"
#include "sample_grids.hpp"
#include "simulated_ranks.hpp"

using namespace nestgrid_test;

// What callgrind counts: a function with this name around each step.
#define STEP(name)                                                                          \
    extern "C" __attribute__((noinline)) void name(const std::function<void()>& function) { \
        function();                                                                         \
        asm volatile("");                                                                   \
    }
STEP(step_grid)
STEP(step_field)
STEP(step_preroll)
STEP(step_surface)
STEP(step_coarse_surface)
#undef STEP

namespace {

std::size_t drawn = 0;

template <class Grid, class Field>
void draw(const Grid& grid, const Field& field) {
    std::optional<HierarchicalIndicator> indicator;
    step_preroll([&] { indicator.emplace(grid, field); });
    step_surface([&] {
        drawn += isosurface(grid, field, 0.0, under(*indicator, 0)).surface.simplices.size();
    });
    step_coarse_surface([&] {
        drawn += isosurface(grid, field, 0.01, under(*indicator, 0.01)).surface.simplices.size();
    });
}

}  // namespace

int main(int argc, char** argv) {
    const bool on_ranks = argc > 1 && std::string(argv[1]) == "ranks";
    const std::size_t leaves = argc > 2 ? static_cast<std::size_t>(std::atol(argv[2])) : 60000;
    auto made = BalancedOctree::grids()[0];
    while (made.leaf_count() < leaves) {
        made.adapt(
            [](const Leaf& leaf) { return near_sphere(leaf, 3, 1.2) ? Mark::refine : Mark::keep; });
    }
    const Whole whole(made);
    std::vector<double> values;
    for (const Point& x : whole.positions) {
        values.push_back(to_sphere(x, 3) + 0.05 * std::sin(20 * x[0]));
        values.push_back(0);
    }
    const Part part(whole, std::vector<int>(whole.leaves, 0), 0);
    const CutGrid<3> grid(whole, on_ranks ? &part : nullptr, false);
    const CutField<3, double> field{&grid, &values};
    if (on_ranks) {
        SimulatedRanks::run(1, [&](Ranks& ranks) {
            std::optional<Distributed<CutGrid<3>>> distributed;
            step_grid([&] { distributed.emplace(grid, ranks); });
            std::optional<DistributedField<CutGrid<3>, CutField<3, double>>> far;
            step_field([&] { far.emplace(*distributed, field); });
            draw(*distributed, *far);
        });
    } else {
        draw(grid, field);
    }
    std::printf("leaves %u\ntriangles %zu\n", whole.leaves, drawn);
}
