// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

/// The greatest distance between two of some points.
inline double diameter_of(std::span<const Point> points) {
    double greatest = 0;  // squared
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            const Point between = points[i] - points[k];
            greatest = std::max(greatest, dot(between, between));
        }
    }
    return std::sqrt(greatest);
}

}  // namespace nestgrid::engine
