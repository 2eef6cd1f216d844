// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"
#include "sinks.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    for (const auto& lattice : lattices(std::integral_constant<int, 2>())) {
        const Sampled<float, 2> samples(lattice.geometry);
        const LatticeBisection<2> grid(lattice.geometry);
        if (lattice.geometry.block_levels >= 0) continue;
        record_sinks(std::string("sinks_lattice_bisection2/") + lattice.name, grid,
                     samples.on(grid));
    }
    return finish(count, arguments);
}
