// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Catches by its type what the library throws, in a program that may hide its symbols.
#include <cstdio>
#include <limits>
#include <vector>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

extern "C" [[gnu::visibility("default")]] int refused() {
    const std::vector<float> samples(27, 1.0F);
    const nestgrid::LatticeBisection<3> grid({.samples = {3, 3, 3}});
    const nestgrid::LatticeField field(grid, std::span<const float>(samples));
    try {
        nestgrid::isosurface(grid, field, std::numeric_limits<double>::quiet_NaN());
    } catch (const nestgrid::InvalidInput& e) {
        std::printf("refused: %s\n", e.what());
        return 1;
    }
    return 0;
}

#ifndef NESTGRID_PLUGIN
int main() { return refused() == 1 ? 0 : 1; }
#endif
