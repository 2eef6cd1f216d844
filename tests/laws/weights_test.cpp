// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Criteria with weights between 0 and 1 (paper, section 6), on every family.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "closedness.hpp"
#include "curved.hpp"
#include "families.hpp"
#include "hausdorff.hpp"
#include "projection.hpp"
#include "refusal.hpp"
#include "same_surface.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace weights_test {

template <class Family>
class Weights : public testing::Test {};
TYPED_TEST_SUITE(Weights, Families);

/// Calls test(grid, field) on refined grids of a family.
template <class Family, class Test>
void on_refined_grids(unsigned seed, Test&& test) {
    for_each_field_at_sphere<Family>(3, seed, [&](const auto& grid, const NodalSamples& samples) {
        test(grid, NodeField<typename Family::Grid, double>(grid, samples.values));
    });
}

TYPED_TEST(Weights, DrawClosedSurfaces) {
    on_refined_grids<TypeParam>(11, [](const auto& grid, const auto& field) {
        const HierarchicalIndicator indicator(grid, field, Spread{.factor = 1.5});
        for (const double epsilon : {0.003, 0.03, 0.3}) {
            const Blended blended(&indicator, epsilon, 1.5);
            expect_closed(isosurface(grid, field, 0.0, under(blended, indicator)).surface);
            const Threshold other(&indicator, epsilon / 2);
            expect_closed(isosurface(grid, field, 0.0, under(blended && other, indicator)).surface);
            expect_closed(isosurface(grid, field, 0.0, under(blended || other, indicator)).surface);
        }
    });
}

TYPED_TEST(Weights, OfOneOrNothingAreAThreshold) {
    on_refined_grids<TypeParam>(12, [](const auto& grid, const auto& field) {
        const HierarchicalIndicator indicator(grid, field);
        const Threshold threshold(&indicator, 0.03);
        const auto expected = isosurface(grid, field, 0.0, under(threshold, indicator));
        const auto blended =
            isosurface(grid, field, 0.0, under(Blended(&indicator, 0.03, 1), indicator));
        expect_same_simplices(blended.surface, expected.surface);
    });
}

/// |dP / d epsilon| <= C^2 / (C - 1).
TYPED_TEST(Weights, MoveTheProjectionContinuously) {
    const double step = 1e-4;
    on_refined_grids<TypeParam>(13, [&](const auto& grid, const auto& field) {
        for (const double c : {1.25, 2.0, 4.0}) {
            const HierarchicalIndicator indicator(grid, field, Spread{.factor = c});
            const auto at = [&](double epsilon) {
                return projection(grid, field, Blended(&indicator, epsilon, c), indicator);
            };
            const double rounding = 1e-7 * (indicator.greatest() - indicator.least());
            for (const double epsilon : {0.003, 0.05}) {
                EXPECT_LE(greatest_moves(at(epsilon), at(epsilon + step)).value,
                          c * c / (c - 1) * step + rounding);
            }
        }
    });
}

/// Where elements stop, simplices draw what their children drew: no step.
TYPED_TEST(Weights, MoveSurfacesOnSimplicesContinuously) {
    using Grid = typename TypeParam::Grid;
    if constexpr (std::is_same_v<Grid, BisectionGrid<Grid::dimension>> ||
                  std::is_same_v<Grid, RedGreenSimplices<Grid::dimension>>) {
        for (auto& grid : TypeParam::grids()) {
            for (int i = 0; i < 3 * TypeParam::steps; ++i) grid.refine_uniformly();
            const auto values =
                sample_nodes(grid, [](const Point& x) { return to_sphere(x, Grid::dimension); });
            const NodeField<Grid, double> field(grid, values);
            const HierarchicalIndicator indicator(grid, field, Spread{.factor = 1.5});
            const auto at = [&](double epsilon) {
                return isosurface(grid, field, 0.0,
                                  under(Blended(&indicator, epsilon, 1.5), indicator))
                    .surface;
            };
            const double step = 1e-4;
            auto before = at(0.004);
            for (double epsilon = 0.004 + step; epsilon < 0.008; epsilon += step) {
                auto after = at(epsilon);
                // 4.5 for the values, and the gradient is not below 1/4.
                EXPECT_LE(figures::hausdorff_distance(before, after), 4 * 4.5 * step) << epsilon;
                before = std::move(after);
            }
        }
    }
}

/// Positions that the grid gives are blended like values.
TEST(WeightsOnCurvedGrids, MovePositionsContinuously) {
    std::mt19937 random(16);
    const double c = 1.5;
    for (int i = 0; i < 4; ++i) {
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 60);
        const CurvedGrid grid(forest);
        const CurvedField field(grid, [](const Point& x) { return norm(x) - 1.1; });
        const HierarchicalIndicator indicator(grid, field, Spread{.factor = c});
        auto before = projection(grid, field, Blended(&indicator, 0.001, c), indicator);
        double moved = 0;
        for (double epsilon = 0.001; epsilon < 0.2; epsilon *= 1.02) {
            const Blended s(&indicator, 1.02 * epsilon, c);
            auto after = projection(grid, field, s, indicator);
            const Moves moves = greatest_moves(before, after);
            moved = std::max(moved, moves.position);
            // Nodes lie at most 0.06 sqrt(3) from their interpolants.
            EXPECT_LE(moves.position, c / (c - 1) * 0.02 * 0.06 * std::sqrt(3));
            expect_closed(
                isosurface(grid, field, 0.0, under(s, indicator), {.verify = true}).surface);
            before = std::move(after);
        }
        EXPECT_GT(moved, 0);
    }
}

TYPED_TEST(Weights, AreRefusedWithoutTheFactor) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    expect_refused(
        [&] { isosurface(grid, field, 0.0, under(Blended(&indicator, 0.1, 1.5), indicator)); },
        "not saturated");
    expect_refused([&] { HierarchicalIndicator(grid, field, Spread{.factor = 0.5}); }, "factor");
    expect_refused([&] { HierarchicalIndicator(grid, field, Spread{.slope = -1}); }, "slope");
}

}  // namespace weights_test
