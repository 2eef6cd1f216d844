// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// function(number of corners of the shape): a constant for hexahedra and tetrahedra, over whose
/// corners the compiler unrolls loops.
template <class Function>
NESTGRID_INLINE decltype(auto) with_corner_count(Shape shape, Function&& function) {
    if (shape == Shape::hexahedron) return function(std::integral_constant<std::size_t, 8>{});
    if (shape == Shape::tetrahedron) return function(std::integral_constant<std::size_t, 4>{});
    return function(std::size_t{topology(shape).corners});
}

}  // namespace nestgrid::engine
