// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "criteria.hpp"
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    auto grid = BisectionTetrahedra::grids()[1];
    refine_at_sphere(grid, 2 * 3);
    std::vector<std::vector<double>> values;
    const auto subjects = subjects_on<double>(grid, values);
    const std::string here = "criteria_levels_bisection_grid3/sphere";
    record_levels(here, grid, subjects, 5);
    return finish(count, arguments);
}
