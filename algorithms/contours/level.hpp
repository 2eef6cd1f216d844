// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include <contours/cut_fraction.hpp>

namespace nestgrid::engine {

/// A function on the adaptive grid whose zero is drawn: component `component` of P_S U less
/// `value`. The component may be the data (isosurface) or a function of position (slice), which
/// must be cut at 0.
///
/// Invariant: a node is inside where its component, a number of type Real, is at least
/// least_inside, and outside where it is at most greatest_outside; these are neighbours.
template <class Real>
struct Level {
    std::size_t component;
    double value;
    Real least_inside;
    Real greatest_outside;
    /// Cuts keep this distance from both ends of an edge, in lengths of the edge.
    double least_fraction;

    explicit Level(double at, std::size_t of_component = 0,
                   double least_fraction_of_cuts = least_cut_fraction)
        : component{of_component},
          value{at},
          least_inside{static_cast<Real>(at)},
          least_fraction{least_fraction_of_cuts} {
        constexpr Real infinity = std::numeric_limits<Real>::infinity();
        if (static_cast<double>(least_inside) < at) {
            least_inside = std::nextafter(least_inside, infinity);
        }
        greatest_outside = std::nextafter(least_inside, -infinity);
    }
    /// The place of a cut on an edge, from 0 at its lower to 1 at its higher end.
    double fraction(double low, double high) const {
        return cut_fraction(value, low, high, least_fraction, 1 - least_fraction);
    }
};

}  // namespace nestgrid::engine
