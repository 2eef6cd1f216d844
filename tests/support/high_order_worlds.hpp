// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Worlds of all shapes with data of higher degree, ready to be drawn.
#pragma once

#include <gtest/gtest.h>

#include "degree_world.hpp"
#include "high_order_judge.hpp"
#include "shape_world.hpp"

namespace nestgrid_test {

template <int dim>
using OnBoxes = DrawnWorld<DegreeWorld<dim>, DegreeField<dim>>;
template <int dim>
using OnShapes = DrawnWorld<ShapeWorld<dim>, ShapeField<dim>>;

inline WorldOptions hanging_world(unsigned seed) {
    return {.levels = 2,
            .least_degree = 2,
            .greatest_degree = 5,
            .noise = seed % 3 == 0 ? 0.1 : 0.0,
            .seed = seed};
}

/// Calls function(drawn, seed) with worlds of all shapes in space.
template <class Function>
void for_each_world(unsigned count, const Function& function) {
    for (unsigned seed = 1; seed <= count && !testing::Test::HasFailure(); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Function& of = function;
        of(OnBoxes<3>(hanging_world(seed), functions[seed % functions.size()]), seed);
        constexpr std::array shapes{Cells::simplices, Cells::prisms, Cells::columns, Cells::all,
                                    Cells::pyramids};
        of(OnShapes<3>(shapes[seed % shapes.size()], hanging_world(seed),
                       functions[(seed + 1) % functions.size()]),
           seed);
    }
}

}  // namespace nestgrid_test
