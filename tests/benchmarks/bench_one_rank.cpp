// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A surface drawn as programs on many ranks draw it, on one, and as programs without ranks do:
// count_instructions.py runs both under callgrind, and compares the instructions of each step.
//     bench_one_rank alone|ranks [leaves]
#include <cstdio>
#include <optional>
#include <string>

#include <nestgrid/algorithms/distributed.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "counted_steps.hpp"
#include "simulated_ranks.hpp"

using namespace nestgrid_test;

NESTGRID_COUNTED_STEP(step_grid)
NESTGRID_COUNTED_STEP(step_field)
NESTGRID_COUNTED_STEP(step_preroll)
NESTGRID_COUNTED_STEP(step_surface)
NESTGRID_COUNTED_STEP(step_coarse_surface)

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
    const CountedWorld world(argc > 2 ? argv[2] : nullptr);
    const auto& [whole, values] = world;
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
