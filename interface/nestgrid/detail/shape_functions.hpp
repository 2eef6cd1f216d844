// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// Weights of the corners of a shape at a point of its reference element: linear on simplices,
/// products of these on their products; on the pyramid rational, bilinear on every section across
/// its axis (Bedrosian 1992).
inline std::array<double, max_corners> shape_functions(Shape shape, const Point& at) {
    const auto [x, y, z] = at;
    switch (shape) {
        case Shape::point:
            return {1};
        case Shape::segment:
            return {1 - x, x};
        case Shape::triangle:
            return {1 - x - y, x, y};
        case Shape::quadrilateral:
            return {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
        case Shape::tetrahedron:
            return {1 - x - y - z, x, y, z};
        case Shape::pyramid: {
            const double h = 1 - z;
            if (h <= 0) return {0, 0, 0, 0, 1};
            return {(h - x) * (h - y) / h, x * (h - y) / h, (h - x) * y / h, x * y / h, z};
        }
        case Shape::prism: {
            const double l = 1 - x - y;
            return {l * (1 - z), x * (1 - z), y * (1 - z), l * z, x * z, y * z};
        }
        case Shape::hexahedron:
            break;
    }
    std::array<double, max_corners> w{};
    for (std::size_t i = 0; i < 8; ++i) {
        w[i] =
            ((i & 1U) != 0 ? x : 1 - x) * ((i & 2U) != 0 ? y : 1 - y) * ((i & 4U) != 0 ? z : 1 - z);
    }
    return w;
}

}  // namespace nestgrid
