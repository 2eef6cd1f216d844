// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Expressions of the program: their bounds in a box hold at all of its points, and are near where
// every variable is used once.

#include <algorithm>
#include <cmath>
#include <random>

#include <nestgrid/error.hpp>

#include <gtest/gtest.h>

#include "expression/expression.hpp"

namespace {

using nestgrid::Point;

/// Boxes of random size about the origin, and points in them.
class Boxes {
public:
    explicit Boxes(unsigned seed) : random_{seed} {}

    void next() {
        for (std::size_t d = 0; d < 3; ++d) {
            low_[d] = uniform(-2, 2);
            high_[d] = low_[d] + uniform(0, 0.5);
        }
    }
    /// A corner for i below 8, else any point.
    Point point(unsigned i) {
        Point x;
        for (std::size_t d = 0; d < 3; ++d) {
            const double corner = (i >> d & 1U) != 0 ? high_[d] : low_[d];
            x[d] = i < 8 ? corner : uniform(low_[d], high_[d]);
        }
        return x;
    }
    const Point& low() const { return low_; }
    const Point& high() const { return high_; }

private:
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }

    std::mt19937 random_;
    Point low_{};
    Point high_{};
};

class ExpressionRanges : public testing::TestWithParam<const char*> {};

TEST_P(ExpressionRanges, HoldEveryValueInTheBox) {
    const Expression expression(GetParam());
    Boxes boxes(1);
    int bounded = 0;
    for (int i = 0; i < 500; ++i) {
        boxes.next();
        const ValueRange range = expression.range(boxes.low(), boxes.high());
        if (std::isfinite(range.greatest - range.least)) ++bounded;
        for (unsigned p = 0; p < 40; ++p) {
            double value = 0;
            try {
                value = expression(boxes.point(p));
            } catch (const nestgrid::InvalidInput&) {
                continue;  // it has no value there
            }
            ASSERT_LE(range.least, value) << GetParam();
            ASSERT_GE(range.greatest, value) << GetParam();
        }
    }
    EXPECT_GT(bounded, 50) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(
    Expressions, ExpressionRanges,
    testing::Values("x*x+y*y-4", "-x^2+3*y*sin(z)-1", "gyroid", "sphere", "singularity", "front",
                    "ln(x+y+5)+log(z+3)", "min(x,y,z)-max(x*y,0.3)", "abs(x)^y", "x^3/(y+5)",
                    "tanh(x)*atan(y)-asin(z/4)+acos(z/4)", "cosh(x)-sinh(y)+abs(z)",
                    "exp(2*x+1)-pi", "x^4-y^3+z^2+(x+5)^-3", "sqrt(x+3)^0.7", "min(x,1)^65+y",
                    "x^66-(y+5)^-2", "0.5^x", "sin(1e6*x)", "5", "z", "max(x,sqrt(x))+y", "x^0.5",
                    "max(x,ln(y))", "1/x", "min(z,acos(x))"));

TEST(ExpressionRange, IsThatOfTheValuesWhereEachVariableIsUsedOnce) {
    for (const char* text : {"x*y-z", "x^2+y^2+3*z+1", "sphere", "exp(x)*sin(y/4)+ln(z+3)"}) {
        const Expression expression(text);
        Boxes boxes(2);
        for (int i = 0; i < 50; ++i) {
            boxes.next();
            const ValueRange range = expression.range(boxes.low(), boxes.high());
            double least = INFINITY;
            double greatest = -INFINITY;
            for (unsigned p = 0; p < 2000; ++p) {
                const double value = expression(boxes.point(p));
                least = std::min(least, value);
                greatest = std::max(greatest, value);
            }
            EXPECT_LE(range.greatest - range.least, 1.2 * (greatest - least) + 1e-12) << text;
        }
    }
}

TEST(ExpressionRange, IsInfiniteWhereAnOperationHasNoBounds) {
    for (const char* text : {"x > 0 ? 1 : y", "avg(x,y)", "rint(x)", "atan2(x,y)", "tan(x)", "1/x",
                             "max(y,sqrt(x-1))", "(x-0.5)^0.5", "x^-65", "log(x)"}) {
        const ValueRange range = Expression(text).range({0, 0, 0}, {1, 1, 1});
        EXPECT_EQ(range.least, -INFINITY) << text;
        EXPECT_EQ(range.greatest, INFINITY) << text;
    }
}

}  // namespace
