// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

namespace nestgrid::engine {

/// A function on the adaptive grid whose zero is drawn: component `component` of P_S U less
/// `value`. The component may be the data (isosurface) or a function of position (slice).
///
/// Invariant: a node is inside where its component, a number of type Real, is at least
/// least_inside, and outside where it is at most greatest_outside; these are neighbours.
template <class Real>
struct Level {
    std::size_t component;
    double value;
    Real least_inside;
    Real greatest_outside;

    explicit Level(double at, std::size_t of_component = 0)
        : component{of_component}, value{at}, least_inside{static_cast<Real>(at)} {
        constexpr Real infinity = std::numeric_limits<Real>::infinity();
        if (static_cast<double>(least_inside) < at) {
            least_inside = std::nextafter(least_inside, infinity);
        }
        greatest_outside = std::nextafter(least_inside, -infinity);
    }
};

}  // namespace nestgrid::engine
