// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A distance that is asked for is kept there and back, whatever the criterion draws; nothing is
// lost; and little is drawn more.
#include <gtest/gtest.h>

#include <distances/far_points.hpp>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/measured_error.hpp>

#include "families.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace isosurface_within_test {

constexpr double rounding = 1e-9;

/// The length of the box around a surface.
double extent(const Surface<3>& s) { return engine::Box::around(s.vertices).diameter(); }

template <class Family>
class IsosurfacesWithin : public testing::Test {};
TYPED_TEST_SUITE(IsosurfacesWithin, Families);

TYPED_TEST(IsosurfacesWithin, KeepTheDistanceThereAndBack) {
    if constexpr (TypeParam::Grid::dimension == 3) {
        for_each_field_at_sphere<TypeParam>(2, 3, [](const auto& grid, const auto& samples) {
            const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
            const auto h = erase(grid, field);
            const HierarchicalIndicator indicator(h);
            const auto whole = isosurface<3>(h, 0.0, under(Exact{}, indicator)).surface;
            if (whole.simplices.empty()) return;
            // Criteria that promise nothing: all is as coarse as it can be, or hardly so.
            const double range = indicator.greatest() - indicator.least();
            for (const double part : {0.02, 0.2}) {
                const double distance = part * extent(whole);
                for (const double threshold : {10 * range, 0.05 * range}) {
                    const Threshold coarse(&indicator, threshold);
                    const auto draw = [&](const Executor& executor) {
                        return isosurface_within(h, 0.0, {whole, distance}, coarse, indicator, {},
                                                 executor);
                    };
                    const IsosurfaceWithin kept = draw(SequentialExecutor{});
                    const Surface<3>& drawn = kept.isosurface.surface;
                    const MeasuredError error = measure_error(h, drawn, whole, 0.0, 2000);
                    EXPECT_LE(error.distance.greatest, distance * (1 + rounding));
                    EXPECT_LE(error.back.greatest, distance * (1 + rounding));
                    EXPECT_EQ(kept.rounds == 0, kept.points == 0);
                    expect_same(drawn, draw(ThreadExecutor(3)).isosurface.surface);
                }
            }
        });
    }
}

/// A peak at one node, far from all others: coarse elements know nothing of it.
TEST(IsosurfacesWithinDistances, LoseNoPeak) {
    const LatticeBisection<3> grid({.samples = {17, 17, 17}});
    std::vector<float> values(grid.node_count(), -1);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 17 < 8 ? 1 : -1;
    values[(7 * 17 + 9) * 17 + 13] = 1;
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const auto whole = isosurface(grid, field, 0.0, under(Exact{}, indicator)).surface;
    const Threshold coarse(&indicator, 100);
    const IsosurfaceOptions options{.cuts = Cuts::finest};
    const auto lost = isosurface(grid, field, 0.0, under(coarse, indicator), options).surface;
    EXPECT_GT(measure_error({grid, field}, lost, whole, 0.0, 20000).back.greatest, 5);
    const auto kept =
        isosurface_within(erase(grid, field), 0.0, {whole, 0.5}, coarse, indicator, options);
    const MeasuredError error =
        measure_error({grid, field}, kept.isosurface.surface, whole, 0.0, 20000);
    EXPECT_LE(std::max(error.distance.greatest, error.back.greatest), 0.5);
    EXPECT_LT(kept.isosurface.surface.simplices.size(), whole.simplices.size() / 8);
    EXPECT_GT(kept.rounds, 0);
}

TEST(IsosurfacesWithinDistances, EndWhereProgressSaysSo) {
    const LatticeBisection<3> grid({.samples = {33, 33, 33}});
    std::vector<float> values(grid.node_count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i * i % 7 < 3 ? 1 : -1;
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const auto whole = isosurface(grid, field, 0.0, under(Exact{}, indicator)).surface;
    const Threshold coarse(&indicator, 100);
    int told = 0;
    const auto draw = [&](int most) {
        told = 0;
        const auto goes_on = [&](const TraversalCounts&) { return ++told < most; };
        return isosurface_within(erase(grid, field), 0.0, {whole, 0.5}, coarse, indicator,
                                 {.progress = goes_on});
    };
    EXPECT_FALSE(draw(1 << 30).isosurface.cancelled);
    const int all = told;
    ASSERT_GT(all, 4);
    for (int most = 1; most < all; most += std::max(1, all / 9)) {
        EXPECT_TRUE(draw(most).isosurface.cancelled);
        EXPECT_EQ(told, most);
    }
}

TEST(FarPoints, AreThoseOfBruteForce) {
    Surface<3> plane;  // z = 0, and a triangle that rises from it to z = 1
    plane.vertices = {{-9, -9, 0}, {9, -9, 0}, {0, 18, 0}};
    plane.simplices = {{0, 1, 2}};
    Surface<3> rising;
    rising.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
    rising.simplices = {{0, 1, 2}};
    const engine::ClosestPoints closest(plane);
    EXPECT_TRUE(engine::far_points(rising, closest, 1.001, SequentialExecutor{}).empty());
    for (const double distance : {0.01, 0.5, 0.9, 0.99}) {
        const auto far = engine::far_points(rising, closest, distance, SequentialExecutor{});
        ASSERT_EQ(far.size(), 1U);
        EXPECT_GT(far[0][2], 0.998 * distance);
        std::uint32_t near = 0;
        EXPECT_TRUE(closest.is_within(far[0], far[0][2] * (1 + rounding), near));
        EXPECT_FALSE(closest.is_within(far[0], far[0][2] * (1 - rounding), near));
    }
    EXPECT_EQ(engine::far_points(rising, engine::ClosestPoints({}), 1, SequentialExecutor{}).size(),
              1U);
}

TEST(IsosurfacesWithinDistances, AreRefusedWhereNothingKeepsThem) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    std::vector<float> values(grid.node_count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 5);
    const LatticeField field(grid, std::span<const float>(values));
    const HierarchicalIndicator indicator(grid, field);
    const Threshold any(&indicator, 1);
    const auto at = [&](double value) {
        return isosurface(grid, field, value, under(Exact{}, indicator)).surface;
    };
    const Surface<3> whole = at(1.5);
    for (const double distance : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
        expect_refused(
            [&] {
                isosurface_within(erase(grid, field), 1.5, {whole, distance}, any, indicator);
            },
            "not a positive number");
    }
    const Surface<3> other = at(3.5);
    expect_refused(
        [&] {
            isosurface_within(erase(grid, field), 1.5, {other, 0.5}, any, indicator);
        },
        "another surface");
}

}  // namespace isosurface_within_test
