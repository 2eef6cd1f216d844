// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "criteria.hpp"
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    auto grid = UnbalancedOctree::grids()[1];
    refine_at_sphere(grid, 3);
    std::vector<std::vector<double>> values;
    const auto subjects = subjects_on<double>(grid, values);
    const std::string here = "criteria_levels_octree_grid3/sphere";
    record_levels(here, grid, subjects, 1);
    return finish(count, arguments);
}
