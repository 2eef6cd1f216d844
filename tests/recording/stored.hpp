// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Stored hierarchies, refined at a sphere and at random.
#pragma once

#include "closedness.hpp"
#include "options.hpp"
#include "sample_grids.hpp"

namespace recording {

using namespace nestgrid_test;

template <class Real, class Grid>
std::vector<Subject<NodeField<Grid, Real>>> subjects_on(const Grid& grid,
                                                        std::vector<std::vector<Real>>& values) {
    std::vector<Subject<NodeField<Grid, Real>>> subjects;
    std::vector<NodalSamples> all = catching_fields(grid.node_positions(), 7);
    values.reserve(all.size());
    for (const NodalSamples& samples : all) {
        values.emplace_back(samples.values.begin(), samples.values.end());
        const bool tiny = samples.name == "5 units in the last place";
        subjects.push_back({samples.name == "plane through nodes and edges" ? "plane"
                            : samples.name == "plateau at the isovalue"     ? "plateau"
                            : tiny                                          ? "ulps"
                            : samples.name == "checkerboard of every level" ? "checkerboard"
                                                                            : samples.name,
                            NodeField<Grid, Real>(grid, values.back()), 0.0, tiny ? 0x1p-52 : 1.0});
    }
    return subjects;
}

/// \param whether all cases, or those with options alone
template <class Family, class Real = double>
void record_family(const std::string& name, bool all = true) {
    auto grids = Family::grids();
    for (std::size_t i = 0; i < grids.size(); ++i) {
        auto& grid = grids[i];
        refine_at_sphere(grid, 2 * Family::steps + (i == 0 && Family::steps < 3 ? 1 : 0));
        std::vector<std::vector<Real>> values;
        const auto subjects = subjects_on<Real>(grid, values);
        const std::string here = name + "/sphere" + std::to_string(i);
        if (i == 0 && all) {
            record_all(here, grid, subjects);
        } else {
            record_options(here, grid, subjects, "zero small large");
        }
    }
    auto grid = Family::grids()[1];
    std::mt19937 random(5);
    refine_at_random(grid, random, 3 * Family::steps, std::numeric_limits<int>::max(), 4,
                     Family::Grid::dimension == 3 ? 400 : 800);
    std::vector<std::vector<Real>> values;
    const auto subjects = subjects_on<Real>(grid, values);
    record_preroll(name + "/random", grid, subjects);
    record_options(name + "/random", grid, subjects);
    record_threads(name + "/random", grid, subjects);
}

}  // namespace recording
