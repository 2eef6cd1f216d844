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
#include <type_traits>

#include <nestgrid/detail/inlining.hpp>

namespace nestgrid {

/// \tparam Number float, double, or several at once (pack.hpp)
template <class Number>
NESTGRID_INLINE constexpr Number scaled(const Number& x, double by) {
    if constexpr (std::is_floating_point_v<Number>) {
        return x * static_cast<Number>(by);
    } else {
        return x * Number::all(static_cast<typename Number::value_type>(by));
    }
}

template <class Number>
NESTGRID_INLINE constexpr Number midpoint(const Number& a, const Number& b) {
    return scaled(a + b, 0.5);
}

/// Mean of the corners of a quadrilateral face in tensor order: a mean of two opposite edge sums,
/// of the two pairings the smaller one. The sum of two numbers on one side of a threshold stays on
/// that side, so the mean has the sign of one of the two edge midpoints it averages.
template <class Number>
NESTGRID_INLINE constexpr Number face_mean(const Number& a, const Number& b, const Number& c,
                                           const Number& d) {
    using std::min;
    return scaled(min((a + b) + (c + d), (a + c) + (b + d)), 0.25);
}

/// Ascending, without a branch.
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

/// Mean of the corners of a hexahedron, in any order: as ordered_sum(), whose order nobody could
/// predict.
template <class Number>
NESTGRID_INLINE constexpr Number cell_mean(std::array<Number, 8> x) {
    using std::max;
    using std::min;
    sort_eight(x);
    Number sum = scaled(x[0], 0.125);
    for (std::size_t i = 1; i < 8; ++i) sum = sum + scaled(x[i], 0.125);
    return min(max(sum, x[0]), x[7]);
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
