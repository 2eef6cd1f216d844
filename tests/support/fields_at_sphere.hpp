// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What most tests over families of hierarchies begin with.
#pragma once

#include <gtest/gtest.h>

#include "closedness.hpp"
#include "sample_grids.hpp"

namespace nestgrid_test {

/// Calls test(grid, samples) for the grids of a family, refined at the sphere, and each of the
/// catching fields on them.
/// \param levels of the refinement; families bisect `steps` times a level
template <class Family, class Test>
void for_each_field_at_sphere(int levels, unsigned seed, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, levels * Family::steps);
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), seed)) {
            SCOPED_TRACE(samples.name);
            test(grid, samples);
        }
    }
}

}  // namespace nestgrid_test
