// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Criteria that the engine carries beyond a threshold: weights between 0 and 1 (paper, section 6)
// and distances (section 4.3), on every family.
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace {

/// Fine in a ball, coarser by the distance from it: eta <= distance + epsilon.
class NearBall final : public Criterion {
public:
    NearBall(const HierarchicalIndicator& indicator, const Point& centre, double radius)
        : indicator_{&indicator}, centre_{centre}, radius_{radius} {}

    NodeMask holds(const NewNodes& nodes) const override {
        NodeMask mask = 0;
        for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
            const double distance = std::max(norm(nodes.positions[n] - centre_) - radius_, 0.0);
            const double allowed = distance * (1 - 0x1p-10);
            mask |= NodeMask{indicator_->stop(nodes.keys[n]) <= allowed} << n;
        }
        return mask & ~nodes.outside;
    }
    bool wants_positions() const override { return true; }
    bool saturated() const override { return indicator_->spread().slope >= 1; }

private:
    const HierarchicalIndicator* indicator_;
    Point centre_;
    double radius_;
};

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
            expect_closed(isosurface(grid, field, 0.0, blended, indicator).surface);
            const Threshold other(&indicator, epsilon / 2);
            expect_closed(isosurface(grid, field, 0.0, blended && other, indicator).surface);
            expect_closed(isosurface(grid, field, 0.0, blended || other, indicator).surface);
        }
    });
}

TYPED_TEST(Weights, OfOneOrNothingAreAThreshold) {
    on_refined_grids<TypeParam>(12, [](const auto& grid, const auto& field) {
        const HierarchicalIndicator indicator(grid, field);
        const Threshold threshold(&indicator, 0.03);
        const auto expected = isosurface(grid, field, 0.0, threshold, indicator);
        const auto blended = isosurface(grid, field, 0.0, Blended(&indicator, 0.03, 1), indicator);
        EXPECT_EQ(blended.surface.vertices, expected.surface.vertices);
        EXPECT_EQ(blended.surface.simplices, expected.surface.simplices);
    });
}

/// P_S U at the nodes of the adaptive grid.
template <class Grid>
std::map<NodeKey, double> projection(const Grid& grid, const NodeField<Grid, double>& field,
                                     const Criterion& criterion,
                                     const HierarchicalIndicator& indicator) {
    std::map<NodeKey, double> values;
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.keys = true}, indicator.hanging());
    engine::project(walk, criterion, [&](const engine::ElementView<double>& view) {
        std::array<NodeKey, max_corners> keys{};
        walk.corners(view, keys.data(), nullptr);
        for (std::size_t i = 0; i < view.corner_count(); ++i) {
            const auto [at, is_new] = values.emplace(keys[i], view.value[i]);
            EXPECT_EQ(at->second, view.value[i]);
        }
    });
    return values;
}

/// |dP / d epsilon| <= C^2 / (C - 1), which is 4.5 for C = 1.5.
TYPED_TEST(Weights, MoveTheProjectionContinuously) {
    on_refined_grids<TypeParam>(13, [](const auto& grid, const auto& field) {
        const HierarchicalIndicator indicator(grid, field, Spread{.factor = 1.5});
        const double epsilon = 0.05;
        const double step = 1e-6;
        const auto before = projection(grid, field, Blended(&indicator, epsilon, 1.5), indicator);
        const auto after =
            projection(grid, field, Blended(&indicator, epsilon + step, 1.5), indicator);
        for (const auto& [key, value] : before) {
            const auto at = after.find(key);
            if (at == after.end()) continue;
            EXPECT_LE(std::abs(at->second - value), 4.6 * step);
        }
    });
}

TYPED_TEST(Weights, AreRefusedWithoutTheFactor) {
    auto grid = TypeParam::grids()[0];
    refine_at_sphere(grid, 2 * TypeParam::steps);
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    expect_refused([&] { isosurface(grid, field, 0.0, Blended(&indicator, 0.1, 1.5), indicator); },
                   "not saturated");
    expect_refused([&] { HierarchicalIndicator(grid, field, Spread{.factor = 0.5}); }, "factor");
    expect_refused([&] { HierarchicalIndicator(grid, field, Spread{.slope = -1}); }, "slope");
}

TYPED_TEST(Weights, ByDistanceDrawClosedSurfaces) {
    std::mt19937 random(14);
    on_refined_grids<TypeParam>(15, [&](const auto& grid, const auto& field) {
        const HierarchicalIndicator indicator(grid, field, Spread{.slope = 1});
        for (int i = 0; i < 4; ++i) {
            const Point centre{uniform(random), uniform(random), uniform(random)};
            const NearBall near(indicator, centre, 0.3 * uniform(random));
            expect_closed(isosurface(grid, field, 0.0, near, indicator).surface);
        }
    });
}

}  // namespace
