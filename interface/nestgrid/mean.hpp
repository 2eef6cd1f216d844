// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sums in an order that depends on the values alone.
//
// A node is interpolated by every element that creates it, each numbering its corners in its own
// way. Summation order changes the last bit of a sum of four in a quarter of all cases, so every
// mean here is a symmetric function of its arguments, to the last bit: shared values are equal
// without any key, whatever the numbering, the mirror image or the thread.
// Consequence: every mean lies between the least and the greatest of its arguments.
// Values must stay below a quarter of the largest number of their type.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace nestgrid {

template <class Real>
constexpr Real midpoint(Real a, Real b) {
    return (a + b) * Real(0.5);
}

/// Mean of the corners of a quadrilateral face in tensor order: a mean of two opposite edge sums,
/// of the two pairings the smaller one. The sum of two numbers on one side of a threshold stays on
/// that side, so the mean has the sign of one of the two edge midpoints it averages.
template <class Real>
constexpr Real face_mean(Real a, Real b, Real c, Real d) {
    return std::min((a + b) + (c + d), (a + c) + (b + d)) * Real(0.25);
}

/// Weighted sum, products added in ascending order and clamped to the range of the values.
/// `product` holds weight times value and is destroyed; lo and hi bound the values.
template <class Real>
constexpr Real ordered_sum(std::span<Real> product, Real lo, Real hi) {
    std::sort(product.begin(), product.end());
    Real sum = 0;
    for (const Real p : product) sum += p;
    return std::clamp(sum, lo, hi);
}

}  // namespace nestgrid
