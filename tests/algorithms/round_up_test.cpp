// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arithmetic that never rounds down gives the least number that is not below.
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <indicators/packed_round_up.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>

using namespace nestgrid;
using namespace nestgrid::engine;

namespace round_up_test {

using Floats = Pack<float, 4>;

/// Differences and sums of these are exact with double precision.
float number(std::mt19937& random) {
    const auto digits = static_cast<double>(static_cast<std::int32_t>(random()) >> 7);
    return static_cast<float>(std::ldexp(digits, -static_cast<int>(random() % 28)));
}

void expect_least_above(float found, double exact) {
    EXPECT_GE(static_cast<double>(found), exact);
    if (found > 0) {
        EXPECT_LT(static_cast<double>(std::nextafter(found, 0.0F)), exact);
    }
}

TEST(RoundUp, GivesTheLeastNumberNotBelow) {
    std::mt19937 random(1);
    int rounded = 0;
    for (int round = 0; round < 100000; ++round) {
        const float a = number(random);
        const float b = round % 7 == 0 ? a : number(random);
        const double distance = std::abs(double{a} - double{b});
        expect_least_above(detail::distance_above(a, b), distance);
        expect_least_above(detail::distance_above(b, a), distance);
        const double sum = std::abs(double{a}) + std::abs(double{b});
        expect_least_above(detail::sum_above(std::abs(a), std::abs(b)), sum);
        expect_least_above(detail::float_above(sum), sum);
        const float coarse = detail::bfloat16_value(detail::bfloat16_above(std::abs(a)));
        EXPECT_GE(coarse, std::abs(a));
        EXPECT_LE(coarse, std::abs(a) * (1 + 0x1p-7F));
        rounded += static_cast<double>(detail::distance_above(a, b)) != distance;
    }
    EXPECT_GT(rounded, 10000);
}

TEST(RoundDown, GivesTheGreatestBfloat16NotAbove) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::mt19937 random(3);
    for (int round = 0; round < 100000; ++round) {
        const double x = std::abs(double{number(random)}) * (1 + 1e-9);
        const std::uint16_t below = detail::bfloat16_below(x);
        EXPECT_LE(static_cast<double>(detail::bfloat16_value(below)), x);
        EXPECT_GT(
            static_cast<double>(detail::bfloat16_value(static_cast<std::uint16_t>(below + 1))), x);
    }
    EXPECT_EQ(detail::bfloat16_below(0.0), 0);
    EXPECT_EQ(detail::bfloat16_below(-0.0), 0);
    EXPECT_EQ(detail::bfloat16_below(infinity), detail::bfloat16_infinity);
    EXPECT_EQ(detail::bfloat16_below(1e300), detail::bfloat16_infinity - 1);
}

TEST(RoundUp, GivesTheSameOfSeveralAtOnce) {
    std::mt19937 random(2);
    for (int round = 0; round < 100000; ++round) {
        std::array<float, 4> a;
        std::array<float, 4> b;
        for (std::size_t i = 0; i < 4; ++i) {
            a[i] = number(random);
            b[i] = (random() & 7U) == 0 ? a[i] : number(random);
        }
        const auto distances =
            distance_above(Floats::load(a.data()), Floats::load(b.data())).numbers();
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(distances[i], distance_above(a[i], b[i]));
        for (std::size_t i = 0; i < 4; ++i) {
            a[i] = std::abs(a[i]);
            b[i] = std::abs(b[i]);
        }
        if (round == 0) a[1] = std::numeric_limits<float>::infinity();
        if (round == 0) a[2] = b[2] = std::numeric_limits<float>::max();
        const auto sums = sum_above(Floats::load(a.data()), Floats::load(b.data())).numbers();
        const auto coarse = bfloat16_above(Floats::load(a.data())).numbers();
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(sums[i], sum_above(a[i], b[i]));
            EXPECT_EQ(coarse[i], std::uint32_t{detail::bfloat16_above(a[i])} << 16U);
        }
    }
}

}  // namespace round_up_test
