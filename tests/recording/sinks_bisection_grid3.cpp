// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sinks.hpp"
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    auto grid = BisectionTetrahedra::grids()[1];
    refine_at_sphere(grid, 6);
    std::vector<std::vector<double>> values;
    record_sinks("sinks_bisection_grid3/sphere", grid, subjects_on<double>(grid, values));
    return finish(count, arguments);
}
