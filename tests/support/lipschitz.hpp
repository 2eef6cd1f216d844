// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/domains.hpp>

namespace nestgrid_test {

/// The distance is 0 exactly at the points inside, and has the Lipschitz constant 1: between random
/// points between -1.5 and 1.5 that are far apart, and such that are near.
/// \param inside bool(const nestgrid::Point&); points nearer to the boundary than 1e-9 do not count
template <class Inside>
void expect_lipschitz(const nestgrid::Distance& distance, const Inside& inside) {
    using nestgrid::operator+;
    using nestgrid::operator-;
    using nestgrid::operator*;
    std::mt19937 random(31);
    std::uniform_real_distribution<double> number(-1.5, 1.5);
    const auto point = [&] {
        return nestgrid::Point{number(random), number(random), number(random)};
    };
    int within = 0;
    for (int i = 0; i < 20000; ++i) {
        const nestgrid::Point x = point();
        const double scale = i % 2 == 0 ? 1 : 0.001;
        const nestgrid::Point y = x + scale * (point() - x);
        const double d = distance(x);
        ASSERT_GE(d, 0);
        ASSERT_LE(std::abs(d - distance(y)), (1 + 1e-12) * nestgrid::norm(x - y) + 1e-15);
        if (d > 0 && d < 1e-9) continue;
        ASSERT_EQ(d == 0, inside(x)) << nestgrid::text_of(x);
        within += d == 0 ? 1 : 0;
    }
    EXPECT_GT(within, 20) << "no points inside";
    EXPECT_LT(within, 19980) << "no points outside";
}

}  // namespace nestgrid_test
