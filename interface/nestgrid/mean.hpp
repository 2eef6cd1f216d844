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
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <nestgrid/inlining.hpp>

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

/// Ascending, without a branch.
/// \tparam Number Real, or several at once
template <class Number>
NESTGRID_INLINE constexpr void sort_eight(std::array<Number, 8>& x) {
    // Batcher's network: the two of each pair are put in order.
    constexpr std::array<std::uint8_t, 38> pairs{0, 1, 2, 3, 4, 5, 6, 7, 0, 2, 1, 3, 4,
                                                 6, 5, 7, 1, 2, 5, 6, 0, 4, 3, 7, 1, 5,
                                                 2, 6, 1, 4, 3, 6, 2, 4, 3, 5, 3, 4};
    unrolled<pairs.size() / 2>([&](auto i) NESTGRID_INLINE_LAMBDA {
        using std::max;
        using std::min;
        Number& a = x[pairs[2 * i]];
        Number& b = x[pairs[2 * i + 1]];
        const Number less = min(a, b);
        b = max(a, b);
        a = less;
    });
}

/// Weighted sum, products added in ascending order and clamped to the range of the values.
/// `product` holds weight times value and is destroyed; lo and hi bound the values.
template <class Real>
constexpr Real ordered_sum(std::span<Real> product, Real lo, Real hi) {
    Real sum = 0;
    if (product.size() == 8) {  // of a hexahedron: nobody can predict their order
        std::array<Real, 8> eight;
        std::copy_n(product.begin(), 8, eight.begin());
        sort_eight(eight);
        for (const Real p : eight) sum += p;
    } else {
        std::sort(product.begin(), product.end());
        for (const Real p : product) sum += p;
    }
    return std::clamp(sum, lo, hi);
}

}  // namespace nestgrid
