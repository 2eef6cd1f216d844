// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Norms of offsets, rounded up.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace nestgrid::engine {

/// By how much rounding may make a sum, or the root of a sum, of at most 1,000 terms too small.
inline constexpr double rounded_up = 1 + 0x1p-42;

/// Not below the sum of some numbers that are not negative, and equal to the only one that is not
/// 0.
inline double sum_of(std::span<const double> numbers) {
    double sum = 0;
    double greatest = 0;
    for (const double number : numbers) {
        sum += number;
        greatest = std::max(greatest, number);
    }
    return sum == greatest ? sum : rounded_up * sum;
}

/// Not below the root of the sum of squares, and equal to the only number that is not 0.
inline double euclid_of(std::span<const double> numbers) {
    double greatest = 0;
    for (const double number : numbers) greatest = std::max(greatest, number);
    if (!(greatest > 0) || std::isinf(greatest)) return greatest;
    double sum = 0;
    for (const double number : numbers) sum += (number / greatest) * (number / greatest);
    return sum == 1 ? greatest : greatest * (rounded_up * std::sqrt(sum));
}

}  // namespace nestgrid::engine
