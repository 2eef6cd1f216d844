// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Frame budgets: series of surfaces and slices near a number of triangles, and the exact threshold
// when the motion ends.
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/adapters/lattice_octree.hpp>
#include <nestgrid/algorithms/frame_budget.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>
#include <nestgrid/algorithms/key_frames.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/mesh_size.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "sample_fields.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace frame_budget_test {

/// A bucky ball, or another field of 65^3 samples, on a grid.
template <class Grid>
struct Case {
    SampledField data = sampled_fields({65, 65, 65})[1];
    Grid grid{{.samples = {65, 65, 65}}};
    LatticeField<Grid, float> field{grid, std::span<const float>(data.values)};
    HierarchicalIndicator indicator{grid, field};

    double greatest() const { return indicator.greatest() - indicator.least(); }
    std::size_t triangles(double isovalue, const Criterion& s) const {
        return isosurface(grid, field, isovalue, under(s, indicator)).surface.simplices.size();
    }
};

/// Expects that frames i = 0, ..., 39 are held near a goal, the first ten aside. In three of the
/// rest, where the motion itself changes the number suddenly, within 30 %.
/// \param tolerance as a part of the goal
/// \param triangles of frame i at a threshold
template <class Triangles>
void expect_held(double goal, double tolerance, double greatest, Triangles&& triangles) {
    FrameBudget budget(goal, greatest);
    int far = 0;
    for (int i = 0; i < 40; ++i) {
        const auto drawn = static_cast<double>(triangles(i, budget.threshold()));
        if (i >= 10) {
            EXPECT_NEAR(drawn / goal, 1, 0.3) << "frame " << i;
            far += std::abs(drawn / goal - 1) > tolerance ? 1 : 0;
        }
        budget.drawn(drawn);
    }
    EXPECT_LE(far, 3);
}

template <class Grid>
class FrameBudgets : public testing::Test {};
using Lattices = testing::Types<LatticeBisection<3>, LatticeOctree<3>>;
TYPED_TEST_SUITE(FrameBudgets, Lattices);

TYPED_TEST(FrameBudgets, HoldSurfacesWhileTheIsovalueMoves) {
    const Case<TypeParam> c;
    expect_held(20000, 0.05, c.greatest(), [&](int i, double threshold) {
        return c.triangles(c.data.isovalue + 0.002 * i, Threshold(&c.indicator, threshold));
    });
}

TYPED_TEST(FrameBudgets, HoldSurfacesByAnotherIndicator) {
    const Case<TypeParam> c;
    const SweptIndicator jumps = numerical_indicator({c.grid, c.field});
    expect_held(20000, 0.05, 1, [&](int i, double threshold) {
        return c.triangles(c.data.isovalue + 0.002 * i, Threshold(&jumps, threshold));
    });
}

/// A slice has few triangles here, and single thresholds change a tenth of them.
TYPED_TEST(FrameBudgets, HoldSlicesWhileThePlaneMoves) {
    const Case<TypeParam> c{sampled_fields({65, 65, 65})[2]};  // a gyroid
    expect_held(2500, 0.12, c.greatest(), [&](int i, double threshold) {
        const Plane plane({0, 0, 20 + 0.1 * i}, {0.1, 0.2, 1});
        return slice(c.grid, c.field, plane, under(c.indicator, threshold))
            .surface.simplices.size();
    });
}

/// The eye of a camera flies by; elements are as large as they look equally large from it.
TYPED_TEST(FrameBudgets, HoldSurfacesThatAreFineNearAnEye) {
    const Case<TypeParam> c;
    const SweptIndicator size = mesh_size(c.grid, {.slope = 0.5});
    expect_held(20000, 0.05, 1, [&](int i, double threshold) {
        // [eye]
        const Ball eye{{30 + 0.4 * i, 20, 32}, 0};
        const auto scaled = [&](const Point& x) { return std::min(threshold, 1.0) * eye(x); };
        return c.triangles(c.data.isovalue, Lens(&size, scaled));
        // [eye]
    });
}

TYPED_TEST(FrameBudgets, HoldSurfacesWhileTimeGoesOn) {
    const Case<TypeParam> c;
    std::vector<float> later(c.data.values.rbegin(), c.data.values.rend());
    const LatticeField next(c.grid, std::span<const float>(later));
    const HierarchicalIndicator at_next(c.grid, next);
    expect_held(20000, 0.05, c.greatest(), [&](int i, double threshold) {
        const float t = 0.01F * static_cast<float>(i);
        std::vector<float> values(later);
        for (std::size_t n = 0; n < values.size(); ++n) {
            values[n] = (1 - t) * c.data.values[n] + t * later[n];
        }
        const LatticeField between(c.grid, std::span<const float>(values));
        const KeyFrames at_time({&c.indicator, &at_next}, std::vector{1 - t, t});
        return isosurface(c.grid, between, c.data.isovalue, under(at_time, threshold))
            .surface.simplices.size();
    });
}

/// The whole of an interaction: a slider is dragged through isovalues, then let go.
TYPED_TEST(FrameBudgets, DrawOneSurfaceAFrame) {
    const Case<TypeParam> c;
    const auto& [data, grid, field, indicator] = c;
    constexpr std::size_t most = 20000;
    std::vector<double> slider(20, data.isovalue);
    for (std::size_t i = 1; i < slider.size(); ++i) slider[i] = slider[i - 1] + 0.002;
    std::size_t triangles = 0;
    const auto show = [&](const Isosurface<3>& frame) {
        triangles = frame.surface.simplices.size();
    };
    // [frame_budget]
    IsosurfaceSeries series(grid, field);
    FrameBudget budget(most, indicator.greatest() - indicator.least());
    const auto draw = [&](double isovalue, double threshold) -> const Isosurface<3>& {
        return series.draw(isovalue, {.threshold = threshold});
    };
    for (const double isovalue : slider) {  // while it is dragged
        const Isosurface<3>& frame = draw(isovalue, budget.threshold());
        show(frame);
        budget.drawn(static_cast<double>(frame.surface.simplices.size()));
    }
    const double exact = budget.settle([&](double threshold) {  // when it is let go
        return draw(slider.back(), threshold).surface.simplices.size() <= most;
    });
    show(draw(slider.back(), exact));
    // [frame_budget]
    EXPECT_LE(triangles, most);
    EXPECT_GT(triangles, most * 8 / 10);
}

/// From far above and far below the goal, and from near it.
TYPED_TEST(FrameBudgets, SettleWhereTheSearchForABudgetEnds) {
    const Case<TypeParam> c;
    const double isovalue = c.data.isovalue;
    for (const std::uint64_t goal : {4000U, 20000U, 10'000'000U}) {
        const TriangleBudget exact = isosurface<3>(erase(c.grid, c.field), isovalue,
                                                   under(c.indicator, {.max_triangles = goal}))
                                         .search;
        FrameBudget budget(static_cast<double>(goal), c.greatest());
        for (const double cost : {1.0, 0.0, 1e9, 1.01}) {
            for (int i = 0; i < 3; ++i) budget.drawn(cost * static_cast<double>(goal));
            const double found = budget.settle([&](double threshold) {
                return c.triangles(isovalue, Threshold(&c.indicator, threshold)) <= goal;
            });
            EXPECT_EQ(found, exact.threshold);
            EXPECT_EQ(budget.threshold(), exact.threshold);
        }
    }
}

/// The exact threshold of any step, with few questions where the last threshold was near it.
TEST(FrameBudget, SettlesOnTheLeastThresholdThatFits) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-15, -0.01);
    for (int i = 0; i < 1000; ++i) {
        const double greatest = std::exp2(40 * exponent(random) / 15 + 20);
        const double step = greatest * std::exp2(exponent(random));
        FrameBudget budget(1, greatest);
        const auto fits = [step](double threshold) { return threshold >= step; };
        const double found = budget.settle(fits);
        EXPECT_GE(found, step);
        EXPECT_LE(found, step * (1 + 1.0 / 128));
        budget.drawn(1.03);
        int questions = 0;
        EXPECT_EQ(budget.settle([&](double threshold) { return ++questions, fits(threshold); }),
                  found);
        EXPECT_LE(questions, 10);
    }
}

TEST(FrameBudget, SettlesOnTheEndsOfTheThresholds) {
    FrameBudget budget(1, 0.3);
    EXPECT_EQ(budget.settle([](double) { return false; }), 0.3);
    EXPECT_EQ(budget.threshold(), 0.3);
    EXPECT_EQ(budget.settle([](double) { return true; }), 0);
    EXPECT_EQ(budget.threshold(), 0);
    EXPECT_EQ(budget.settle([](double threshold) { return threshold >= 0.3; }), 0.3);
}

/// The cost of surfaces falls like 1 / threshold, that of lines like its square root.
TEST(FrameBudget, ReachesTheGoal) {
    for (const double power : {-1.0, -0.5}) {
        for (const double goal : {10.0, 1000.0, 0.03}) {
            FrameBudget budget(goal, 2);
            const double reached = 0.01;
            const auto cost = [&](double t) { return goal * std::pow(t / reached, power); };
            for (int i = 0; i < 16; ++i) budget.drawn(cost(budget.threshold()));
            EXPECT_NEAR(budget.threshold(), reached, 1e-4 * reached);
            budget.aim(2 * goal);
            for (int i = 0; i < 16; ++i) budget.drawn(cost(budget.threshold()));
            EXPECT_NEAR(cost(budget.threshold()), 2 * goal, 1e-3 * goal);
        }
    }
}

/// Also after many frames that cost nothing, or far too much.
TEST(FrameBudget, KeepsTheThresholdInItsRange) {
    FrameBudget budget(100, 2);
    for (int i = 0; i < 100; ++i) budget.drawn(0);
    EXPECT_EQ(budget.threshold(), 0);
    for (int i = 0; i < 16; ++i) budget.drawn(1e300);
    EXPECT_EQ(budget.threshold(), 2);
    budget.drawn(std::numeric_limits<double>::infinity());
    EXPECT_EQ(budget.threshold(), 2);
}

TEST(FrameBudget, RefusesNumbersThatMakeNoSense) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double number : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
        EXPECT_THROW(FrameBudget(number, 1), InvalidInput);
        EXPECT_THROW(FrameBudget(1, number), InvalidInput);
        EXPECT_THROW(FrameBudget(1, 1).aim(number), InvalidInput);
    }
    EXPECT_THROW(FrameBudget(1, 1).drawn(nan), InvalidInput);
    EXPECT_THROW(FrameBudget(1, 1).drawn(-1), InvalidInput);
}

}  // namespace frame_budget_test
