// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "criteria.hpp"
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    for (const auto& lattice : lattices(std::integral_constant<int, 3>())) {
        if (lattice.name != std::string("cube") && lattice.name != std::string("padded")) continue;
        const Sampled<float, 3> samples(lattice.geometry);
        const LatticeOctree<3> grid(lattice.geometry);
        const auto subjects = samples.on(grid);
        const std::string here = std::string("criteria_levels_lattice_octree3/") + lattice.name;
        record_levels(here, grid, subjects, 2);
    }
    return finish(count, arguments);
}
