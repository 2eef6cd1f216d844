// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The first isovalue parts the thing from its background: in volumes whose thing is known, nearly
// every sample of the thing is on one side, and nearly every other on the other one.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <random>

#include "drawing/first_isovalue.hpp"

namespace {

constexpr int side = 64;

/// Calls function(x, y, z) for places of a cube from -1 to 1, x fastest.
template <class Function>
auto in_cube(const Function& function) {
    std::vector<decltype(function(0.0, 0.0, 0.0))> values;
    const auto at = [](int i) { return 2.0 * i / (side - 1) - 1; };
    for (int k = 0; k < side; ++k) {
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side; ++i) values.push_back(function(at(i), at(j), at(k)));
        }
    }
    return values;
}

double radius(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

template <class Value>
double isovalue_of(const std::vector<Value>& values) {
    return first_isovalue(value_sample_of(values.size(), [&](std::size_t i) { return values[i]; }));
}

using Inside = std::function<bool(double, double, double)>;

/// What part of the samples of the thing, and of the others, lies above the first isovalue.
struct Parted {
    double isovalue;
    double thing;
    double others;
};

template <class Value>
Parted parted(const std::vector<Value>& values, const Inside& is_thing) {
    const auto things = in_cube([&](double x, double y, double z) { return is_thing(x, y, z); });
    const double isovalue = isovalue_of(values);
    double thing = 0;
    double thing_above = 0;
    double above = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double up = static_cast<double>(values[i]) >= isovalue ? 1 : 0;
        above += up;
        thing += things[i] ? 1 : 0;
        thing_above += things[i] ? up : 0;
    }
    const double others = static_cast<double>(values.size()) - thing;
    return {isovalue, thing_above / thing, (above - thing_above) / others};
}

template <class Value>
void expect_parted(const std::vector<Value>& values, const Inside& is_thing, const char* what) {
    const Parted p = parted(values, is_thing);
    EXPECT_GT(p.thing, 0.95) << what << " at " << p.isovalue;
    EXPECT_LT(p.others, 0.01) << what << " at " << p.isovalue;
}

const Inside ball = [](double x, double y, double z) { return radius(x, y, z) < 0.5; };

/// Air, a body, and bones in it, in Hounsfield units. \param padding around a cylinder; 0 for none
std::vector<std::int16_t> tomography(double noise, int padding) {
    std::mt19937 random(1);
    std::normal_distribution<double> some(0, noise);
    return in_cube([&](double x, double y, double z) -> std::int16_t {
        const double r = radius(x / 0.8, y / 0.6, z / 1.2);
        double value = r < 1 ? 40 : -1000;
        if (std::abs(r - 0.8) < 0.04) value = 700;
        if (std::hypot(x, y - 0.3) < 0.12) value = 1100;
        if (padding != 0 && std::hypot(x, y) > 0.98) return static_cast<std::int16_t>(padding);
        return static_cast<std::int16_t>(std::lround(value + some(random)));
    });
}

TEST(FirstIsovalue, PartsABodyFromAir) {
    const Inside body = [](double x, double y, double z) {
        const bool column = std::hypot(x, y - 0.3) < 0.12;
        return radius(x / 0.8, y / 0.6, z / 1.2) < 1 || column;
    };
    for (const double noise : {1.0, 20.0, 60.0, 120.0}) {
        for (const int padding : {0, -2000, -3024}) {
            expect_parted(tomography(noise, padding), body, "a tomography");
        }
    }
}

TEST(FirstIsovalue, PartsAThingFromANoisyBackground) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 5);
    for (const double inside : {100.0, -100.0}) {
        const auto values = in_cube([&](double x, double y, double z) {
            return (ball(x, y, z) ? inside : 0) + noise(random);
        });
        const Parted p = parted(values, ball);
        EXPECT_NEAR(p.isovalue, inside / 2, 20);
    }
    const Inside small = [](double x, double y, double z) { return radius(x, y, z) < 0.2; };
    expect_parted(in_cube([&](double x, double y, double z) {
                      return static_cast<float>((small(x, y, z) ? 80 : 0) + noise(random));
                  }),
                  small, "a small ball");
    expect_parted(in_cube([&](double x, double y, double z) {
                      const double grey = (ball(x, y, z) ? 90 : 0) + std::abs(noise(random));
                      return static_cast<std::uint8_t>(grey);
                  }),
                  ball, "grey values");
}

TEST(FirstIsovalue, PartsAThingFromAConstantBackground) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 8);
    for (const double background : {0.0, -2000.0, 255.0}) {
        const auto values = in_cube([&](double x, double y, double z) {
            return ball(x, y, z) ? 90 + noise(random) : background;
        });
        const double isovalue = isovalue_of(values);
        EXPECT_GT(std::abs(isovalue - 90), 30) << background;
        EXPECT_GT(std::abs(isovalue - background), 20) << background;
        EXPECT_LT((isovalue - 90) * (isovalue - background), 0) << background;
    }
}

TEST(FirstIsovalue, ShowsEveryLabel) {
    for (const int labels : {1, 2, 7, 150}) {
        const auto values = in_cube([&](double x, double y, double z) -> std::uint16_t {
            if (!ball(x, y, z)) return 0;
            const int octant = (x > 0 ? 1 : 0) + (y > 0 ? 2 : 0) + (z > 0 ? 4 : 0);
            return static_cast<std::uint16_t>(1 + 37 * octant % labels);
        });
        const double isovalue = isovalue_of(values);
        EXPECT_GT(isovalue, 0) << labels;
        EXPECT_LT(isovalue, 1) << labels;
    }
    EXPECT_EQ(isovalue_of(in_cube([](double x, double y, double z) -> std::uint8_t {
                  return ball(x, y, z) ? 255 : 0;
              })),
              127.5);
}

TEST(FirstIsovalue, IsWhereSmoothDataChangeTheirSign) {
    for (const double r : {0.2, 0.5, 1.1}) {
        const auto distance =
            in_cube([&](double x, double y, double z) { return radius(x, y, z) - r; });
        EXPECT_EQ(isovalue_of(distance), 0) << r;
        const auto cut = in_cube([&](double x, double y, double z) {
            return std::clamp((r - radius(x, y, z)) / 0.1, -1.0, 1.0);
        });
        EXPECT_EQ(isovalue_of(cut), 0) << r;
    }
}

TEST(FirstIsovalue, DoesNotFollowValuesFarOff) {
    std::size_t count = 0;
    for (const double far : {1e30, -1e30}) {
        const auto values = in_cube([&](double x, double y, double z) {
            return ++count % 40000 == 0 ? far : std::exp(-4 * radius(x, y, z));
        });
        EXPECT_GT(isovalue_of(values), 0.02) << far;
        EXPECT_LT(isovalue_of(values), 0.9) << far;
    }
    // A value that stands for none, around data that lie close together.
    const auto padded = in_cube([&](double x, double y, double z) {
        const double r = radius(x, y, z);
        return r < 0.9 ? 300 + 10 * std::exp(-8 * r * r) : -9999;
    });
    EXPECT_GT(isovalue_of(padded), 300);
    EXPECT_LT(isovalue_of(padded), 310);
}

TEST(UsualRange, LeavesOutAFewValuesFarOffAndNothingElse) {
    const auto range_of = [](const auto& values) {
        return usual_range(
            value_sample_of(values.size(), [&](std::size_t i) { return values[i]; }));
    };
    std::size_t count = 0;
    const auto far = in_cube([&](double x, double, double) {
        return ++count % 40000 == 0 ? (count % 80000 == 0 ? 1e30 : -1e30) : x;
    });
    const auto range = range_of(far);
    ASSERT_TRUE(range);
    EXPECT_NEAR((*range)[0], -1, 0.2);
    EXPECT_NEAR((*range)[1], 1, 0.2);
    EXPECT_FALSE(range_of(tomography(20, -2000)));
    EXPECT_FALSE(range_of(in_cube(radius)));
    EXPECT_FALSE(range_of(
        in_cube([](double x, double y, double z) { return radius(x, y, z) < 0.05 ? 9.0 : 0.0; })));
}

TEST(FirstIsovalue, LiesWithinTheValues) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int> any(0, 255);
    const auto noise = in_cube([&](double, double, double) { return any(random); });
    EXPECT_GT(isovalue_of(noise), 0);
    EXPECT_LT(isovalue_of(noise), 255);
    std::size_t count = 0;
    const auto one = in_cube([&](double, double, double) { return ++count == 100 ? 1.0 : 0.0; });
    EXPECT_EQ(isovalue_of(one), 0.5);
    EXPECT_EQ(isovalue_of(std::vector{3.0, 3.0, 3.0}), 3);
    EXPECT_EQ(isovalue_of(std::vector{3.0, 4.0}), 3.5);
    const auto slope = in_cube([](double x, double, double) { return 5 + x; });
    EXPECT_NEAR(isovalue_of(slope), 5, 0.1);
}

TEST(FirstIsovalue, IsReadableAndStillBetweenTheValues) {
    const auto readable = [](const std::vector<double>& values) {
        return readable_isovalue(
            value_sample_of(values.size(), [&](std::size_t i) { return values[i]; }));
    };
    EXPECT_EQ(readable({0, 100.0 / 3}), 17);
    EXPECT_EQ(readable({1000.001, 1000.002}), 1000.0015);
    EXPECT_EQ(readable({1.0 / 3, 1.0 / 3}), 1.0 / 3);
    const double next = std::nextafter(1.0, 2.0);
    EXPECT_TRUE(readable({1, next}) == 1 || readable({1, next}) == next);
}

TEST(FirstIsovalue, OfInfiniteValuesIsRefused) {
    for (const std::size_t place : {std::size_t{0}, std::size_t{7}, std::size_t{199}}) {
        std::vector<double> values(200, 1.0);
        values[place] = std::numeric_limits<double>::infinity();
        EXPECT_THROW(isovalue_of(values), nestgrid::InvalidInput);
    }
}

TEST(FirstIsovalue, DoesNotDependOnValuesThatAreMissing) {
    std::vector<double> values;
    for (int i = 0; i < 200; ++i) values.push_back(i < 150 ? 0.01 * (i % 7) : 5 + 0.1 * (i % 13));
    const double expected = isovalue_of(values);
    for (int i = 0; i < 200; ++i) values.insert(values.begin() + 2 * i, std::nan(""));
    EXPECT_EQ(isovalue_of(values), expected);
}

}  // namespace
