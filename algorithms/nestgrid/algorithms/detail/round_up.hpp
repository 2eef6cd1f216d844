// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arithmetic that never rounds down: what keeps a bound a bound in floating point.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace nestgrid::detail {

/// The least float that is not below x >= 0.
inline float float_above(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) < x ? std::nextafter(f, std::numeric_limits<float>::infinity())
                                      : f;
}

/// The greatest float that is not above x.
inline float float_below(double x) {
    const auto f = static_cast<float>(x);
    return static_cast<double>(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity())
                                      : f;
}

/// Rounding error of the sum a + b = s: exactly a + b - s (two-sum, Knuth).
inline double sum_error(double a, double b, double s) {
    const double b_part = s - a;
    return (a - (s - b_part)) + (b - b_part);
}

/// |a - b|, not below the exact difference.
inline double distance_above(double a, double b) {
    const double d = a - b;
    return sum_error(a, -b, d) == 0
               ? std::abs(d)
               : std::nextafter(std::abs(d), std::numeric_limits<double>::infinity());
}

/// The next float above x >= 0 where `raise` is set.
inline float raised(float x, bool raise) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(x) + (raise ? 1U : 0U));
}

/// The least float that is not below |a - b|.
inline float distance_above(float a, float b) {
    const float d = a - b;
    const float b_part = a - d;
    const float error = (a - (d + b_part)) + (b_part - b);
    return raised(std::abs(d), d < 0 ? error < 0 : error > 0);
}

/// The least float that is not below a + b, for a, b >= 0.
inline float sum_above(float a, float b) {
    const float s = a + b;
    const float b_part = s - a;
    const float error = (a - (s - b_part)) + (b - b_part);
    return raised(s, error > 0);
}

inline constexpr std::uint16_t bfloat16_infinity = 0x7F80;

/// Bits of the least bfloat16 that is not below x >= 0; their order is that of the numbers.
inline std::uint16_t bfloat16_above(float x) {
    const auto bits = std::bit_cast<std::uint32_t>(x);
    const std::uint32_t up = (bits >> 16U) + ((bits & 0xFFFFU) != 0 ? 1U : 0U);
    return static_cast<std::uint16_t>(up < bfloat16_infinity ? up : bfloat16_infinity);
}

/// Bits of the greatest bfloat16 that is not above x >= 0.
inline std::uint16_t bfloat16_below(double x) {
    const float positive = float_below(x) + 0.0F;  // 0 where x is -0
    return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(positive) >> 16U);
}

/// The number that has these bits.
inline float bfloat16_value(std::uint16_t bits) {
    return std::bit_cast<float>(std::uint32_t{bits} << 16U);
}

}  // namespace nestgrid::detail
