// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a user chooses at run time, as a value (docs/criteria.md).
#include <cstdio>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/drawing.hpp>

#include "bucky_ball.hpp"

using namespace nestgrid;

int main() {
    constexpr int n = 65;
    const LatticeBisection<3> grid({.samples = {n, n, n}});
    const std::vector<float> samples = bucky_ball(n);
    const LatticeField field(grid, std::span<const float>(samples));
    // [choose]
    Prerolls prerolls(FieldOnGrid(grid, field));  // keeps what each choice needs
    const double level = 0.275;
    for (const char* indicator : {"offset", "error", "wavelet"}) {
        const auto drawn =
            isosurface<3>(prerolls, level, {.threshold = 0.02, .indicator = indicator});
        std::printf("%-7s %6zu triangles\n", indicator, drawn.surface.simplices.size());
    }
    // [choose]
    const double kept =
        isosurface<3>(prerolls, level, {.threshold = 0.02, .indicator = "error"}).surface_error;
    return kept > 0 && kept <= 0.02 ? 0 : 1;
}
