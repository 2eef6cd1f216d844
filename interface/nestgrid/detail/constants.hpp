// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The constants that a grid may name (optional.hpp), or what they are by default.
#pragma once

#include <cstddef>

#include <nestgrid/rule.hpp>

namespace nestgrid::detail {

template <class Grid>
constexpr std::size_t corner_capacity() {
    if constexpr (requires { Grid::max_corners; }) {
        return static_cast<std::size_t>(Grid::max_corners);
    } else {
        return max_corners;
    }
}
template <class Grid>
constexpr std::size_t child_capacity() {
    if constexpr (requires { Grid::max_children; }) {
        return static_cast<std::size_t>(Grid::max_children);
    } else {
        return max_children;
    }
}

/// The shape of all elements, if it is known when the grid is compiled; else Shape::point.
template <class Grid>
constexpr Shape only_shape() {
    constexpr bool simplices = corner_capacity<Grid>() == std::size_t{Grid::dimension} + 1;
    if constexpr (requires { Grid::only_shape; }) {
        return Grid::only_shape;
    } else if constexpr (simplices) {
        return Grid::dimension == 1   ? Shape::segment
               : Grid::dimension == 2 ? Shape::triangle
                                      : Shape::tetrahedron;
    } else {
        return Shape::point;
    }
}

}  // namespace nestgrid::detail
