// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// The gradient of a function that is known by its differences along the axes of an element.
#pragma once

#include <array>
#include <cmath>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// The vectors dual to those along the axes: the gradient of a function that rises by r[d] along
/// axis d is (r[0] of[0] + ...) / volume.
struct DualVectors {
    std::array<Point, 3> of{};
    /// Six times the volume of the tetrahedron that the axes span, with its sign; of two axes twice
    /// the area, of one the square of the length.
    double volume = 0;

    Point gradient(const std::array<double, 3>& rise) const {
        if (volume == 0) return {0, 0, 0};
        Point g{0, 0, 0};
        for (std::size_t d = 0; d < 3; ++d) g = g + (rise[d] / volume) * of[d];
        return g;
    }
};

/// \param along vectors along as many axes as the element has dimensions. Elements of dimension 2
///        and 1 may lie in space; the gradient is tangential to them
inline DualVectors dual_vectors(std::array<Point, 3> along, int dimension) {
    if (dimension == 1) return {{along[0]}, dot(along[0], along[0])};
    if (dimension == 2) {
        along[2] = cross(along[0], along[1]);
        const double area = norm(along[2]);
        if (area > 0) along[2] = (1 / area) * along[2];
    }
    DualVectors dual{
        {cross(along[1], along[2]), cross(along[2], along[0]), cross(along[0], along[1])}};
    dual.volume = dot(along[0], dual.of[0]);
    return dual;
}

}  // namespace nestgrid::engine
