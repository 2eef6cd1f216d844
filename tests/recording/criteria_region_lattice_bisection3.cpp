// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "criteria.hpp"
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    const auto error = [](const auto& e) { return 0.1 * static_cast<double>(e.corner[0] % 11); };
    for (const auto& lattice : lattices(std::integral_constant<int, 3>())) {
        if (lattice.name != std::string("cube") && lattice.name != std::string("padded")) continue;
        const Sampled<float, 3> samples(lattice.geometry);
        const LatticeBisection<3> grid(lattice.geometry);
        const auto subjects = samples.on(grid);
        const std::string here = std::string("criteria_region_lattice_bisection3/") + lattice.name;
        record_region(here, grid, subjects, [](const Point& x) {
            return norm(x - Point{5, 5, 6}) < 4;
        });
        record_own_indicator(here, grid, subjects);
        record_leaf_errors(here, grid, subjects, error);
    }
    return finish(count, arguments);
}
