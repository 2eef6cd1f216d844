// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"
#include "sinks.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    for (const auto& lattice : lattices(std::integral_constant<int, 3>())) {
        const Sampled<float, 3> samples(lattice.geometry);
        const LatticeBisection<3> grid(lattice.geometry);
        if (lattice.geometry.block_levels >= 0) continue;
        record_sinks(std::string("sinks_lattice_bisection3/") + lattice.name, grid,
                     samples.on(grid));
    }
    return finish(count, arguments);
}
