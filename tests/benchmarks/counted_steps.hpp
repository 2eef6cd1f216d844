// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What count_instructions.py counts the instructions of: steps of a drawing on an octree that is
// refined at a sphere.
#pragma once

#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include "cut_grid.hpp"
#include "sample_grids.hpp"

/// A function with this name around each step, by which callgrind finds it.
#define NESTGRID_COUNTED_STEP(name)                                                         \
    extern "C" __attribute__((noinline)) void name(const std::function<void()>& function) { \
        function();                                                                         \
        asm volatile("");                                                                   \
    }

namespace nestgrid_test {

/// An octree with two components at each node, of which the second is 0.
struct CountedWorld {
    Whole whole;
    std::vector<double> values;

    /// \param least number of leaves, as an argument of the program; null: 60000
    explicit CountedWorld(const char* least) : whole{refined(least)} {
        for (const Point& x : whole.positions) {
            values.push_back(to_sphere(x, 3) + 0.05 * std::sin(20 * x[0]));
            values.push_back(0);
        }
    }

private:
    static BalancedOctree::Grid refined(const char* least) {
        const std::size_t leaves =
            least == nullptr ? 60000 : static_cast<std::size_t>(std::atol(least));
        auto grid = BalancedOctree::grids()[0];
        while (grid.leaf_count() < leaves) {
            grid.adapt([](const Leaf& leaf) {
                return near_sphere(leaf, 3, 1.2) ? Mark::refine : Mark::keep;
            });
        }
        return grid;
    }
};

}  // namespace nestgrid_test
