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
    const std::string here = "criteria_region_bisection_grid3/sphere";
    record_region(here, grid, subjects, [](const Point& x) { return x[0] > 0.3 && x[1] > 0.3; });
    record_own_indicator(here, grid, subjects);
    record_leaf_errors(here, grid, subjects,
                       [](const auto& e) { return 0.1 * static_cast<double>(e.corner[0] % 11); });
    return finish(count, arguments);
}
