// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Along which edges the gradients at the corners of a shape are taken.
#pragma once

#include <array>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// A corner where an axis begins and one where it ends, for each axis.
using CornerAxes = std::array<std::array<std::uint8_t, 2>, 3>;

/// How many different gradients the function of an element has at its corners: one on simplices,
/// four at the apex of a pyramid.
constexpr std::size_t gradient_count(Shape shape) {
    if (is_simplex(shape)) return 1;
    return shape == Shape::pyramid ? 8 : topology(shape).corners;
}

/// The edges along which gradient i of a shape is taken. Edges along the same axis of the reference
/// element point the same way for all gradients, but at the apex of a pyramid. Its gradients 4 to 7
/// are taken along three of its four edges each, and the function has their mean for a gradient.
constexpr CornerAxes corner_axes(Shape shape, std::size_t i) {
    const auto at = [](std::size_t corner) { return static_cast<std::uint8_t>(corner); };
    CornerAxes axes{{{0, 1}, {0, 2}, {0, 3}}};
    if (is_simplex(shape)) return axes;
    if (shape == Shape::prism) {
        const std::size_t layer = i < 3 ? 0 : 3;
        axes[0] = {at(layer), at(layer + 1)};
        axes[1] = {at(layer), at(layer + 2)};
        axes[2] = {at(i % 3), at(i % 3 + 3)};
    } else if (shape == Shape::pyramid && i >= 4) {
        for (std::size_t d = 0; d < 3; ++d) axes[d] = {4, at((i + d) % 4)};
    } else {
        for (std::size_t d = 0; d < 3; ++d) {
            const std::size_t bit = std::size_t{1} << d;
            axes[d] = {at(i & ~bit), at(i | bit)};
        }
        if (shape == Shape::pyramid) axes[2] = {at(i), 4};
    }
    return axes;
}

/// corner_axes() of all shapes.
inline constexpr auto corner_axes_of = [] {
    std::array<std::array<CornerAxes, max_corners>, shape_count> of{};
    for (std::size_t shape = 0; shape < shape_count; ++shape) {
        for (std::size_t i = 0; i < max_corners; ++i) {
            of[shape][i] = corner_axes(static_cast<Shape>(shape), i);
        }
    }
    return of;
}();

}  // namespace nestgrid::engine
