// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace nestgrid::engine {

/// A sum of doubles that rounds once, when it is asked for: its bits depend neither on the order of
/// the terms nor on who added which. (The long accumulator of Kulisch, 1971.)
///
/// Digit i counts 2^(32 i - 1088), and is an integer of 64 bits, so that a billion terms leave no
/// carry behind; carry() then brings all digits to -2^31 ... 2^31 - 1, where each sum has one form.
class ExactSum {
public:
    void add(double x) {
        if (!std::isfinite(x)) {
            infinite_ += x;
            return;
        }
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const std::uint64_t exponent = bits >> 52U & 0x7FFU;
        const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52U) - 1);
        const std::uint64_t integer = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52U;
        // x is integer * 2^(place - 1088).
        const std::uint64_t place = (exponent == 0 ? 1 : exponent) + 13;
        const std::uint64_t shift = place % 32;
        const std::uint64_t low = (integer & mask) << shift;
        const std::uint64_t high = (integer >> 32U) << shift;
        const std::array<std::uint64_t, 3> parts{low & mask, (low >> 32U) + (high & mask),
                                                 high >> 32U};
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto part = static_cast<std::int64_t>(parts[i]);
            digits_[static_cast<std::size_t>(place / 32) + i] += std::signbit(x) ? -part : part;
        }
        if (++since_carry_ == most_terms) carry();
    }

    /// Calls function(x) for a few doubles of which this is the sum; the same, for one sum.
    template <class Function>
    void for_each_part(const Function& function) {
        carry();
        for (std::size_t i = 0; i < digits_.size(); ++i) {
            if (digits_[i] != 0) function(std::ldexp(static_cast<double>(digits_[i]), exponent(i)));
        }
        if (infinite_ != 0) function(infinite_);
    }

    /// The nearest double.
    double value() {
        if (infinite_ != 0) return infinite_;
        carry();
        std::size_t top = digits_.size();
        while (top > 0 && digits_[top - 1] == 0) --top;
        if (top == 0) return 0;
        const bool negative = digits_[top - 1] < 0;
        // The digits of the absolute value, from 0 to 2^32 - 1.
        std::array<std::uint64_t, count> digits{};
        std::int64_t borrow = 0;
        for (std::size_t i = 0; i < top; ++i) {
            const std::int64_t digit = (negative ? -digits_[i] : digits_[i]) + borrow;
            digits[i] = static_cast<std::uint64_t>(digit) & mask;
            borrow = digit >> 32;
        }
        if (digits[top - 1] == 0) --top;
        // Its first 64 bits, the last of which is set where any behind them is.
        const auto digit = [&](std::size_t below) {
            return top > below ? digits[top - 1 - below] : std::uint64_t{0};
        };
        const auto zeros = static_cast<std::uint64_t>(std::countl_zero(digit(0) << 32U));
        std::uint64_t first = (digit(0) << 32U | digit(1)) << zeros | digit(2) >> (32 - zeros);
        bool more = (digit(2) << zeros & mask) != 0;
        for (std::size_t below = 3; below < top; ++below) more = more || digit(below) != 0;
        first |= more ? 1U : 0U;
        const double rounded = std::ldexp(static_cast<double>(first),
                                          exponent(top - 1) - 32 - static_cast<int>(zeros));
        return negative ? -rounded : rounded;
    }

private:
    static constexpr std::size_t count = 68;
    static constexpr std::uint64_t mask = 0xFFFFFFFFU;
    static constexpr std::uint32_t most_terms = 1U << 29U;

    static int exponent(std::size_t digit) { return 32 * static_cast<int>(digit) - 1088; }

    void carry() {
        constexpr std::int64_t half = std::int64_t{1} << 31;
        for (std::size_t i = 0; i + 1 < digits_.size(); ++i) {
            const std::int64_t over = (digits_[i] + half) >> 32;
            digits_[i] -= over * 2 * half;
            digits_[i + 1] += over;
        }
        since_carry_ = 0;
    }

    std::array<std::int64_t, count> digits_{};
    std::uint32_t since_carry_ = 0;
    double infinite_ = 0;  // the sum of terms that are infinite or no numbers
};

}  // namespace nestgrid::engine
