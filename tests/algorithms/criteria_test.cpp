// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What algorithms demand of criteria, and criteria by level on every family.
#include <cmath>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/node_levels.hpp>

#include "closedness.hpp"
#include "families.hpp"
#include "refusal.hpp"
#include "sample_fields.hpp"

using namespace nestgrid_test;

namespace criteria_test {

/// Holds at every other node by key, whatever holds around it.
class EveryOther final : public Criterion {
public:
    NodeMask holds(const NewNodes& nodes) const override {
        NodeMask mask = 0;
        for (std::size_t i = 0; i < nodes.keys.size(); ++i) {
            mask |= NodeMask{nodes.keys[i] % 2 == 0} << i;
        }
        return nodes.level < 3 ? 0 : mask & ~nodes.outside;
    }
    bool saturated() const override { return false; }
};

struct SphereOfSamples {
    Samples n{17, 17, 17};
    LatticeBisection<3> grid{{.samples = n}};
    SampledField data = sampled_fields(n)[0];
    LatticeField<LatticeBisection<3>, float> field{grid, std::span<const float>(data.values)};
    HierarchicalIndicator indicator{grid, field};

    template <class S>
    Isosurface<3> draw(const S& criterion) const {
        return isosurface(grid, field, data.isovalue, under(criterion, indicator));
    }
};

TEST(Criteria, ThatAreNotSaturatedAreRefused) {
    const SphereOfSamples s;
    const Threshold saturated(&s.indicator, 0.1);
    expect_refused([&] { s.draw(EveryOther{}); }, "not saturated");
    expect_refused([&] { s.draw(saturated && EveryOther{}); }, "not saturated");
    expect_refused([&] { s.draw(EveryOther{} || saturated); }, "not saturated");
}

TEST(Criteria, ThatInsistLoseTheBound) {
    const SphereOfSamples s;
    const auto insisted = s.draw(Unsaturated{EveryOther{}});
    EXPECT_EQ(insisted.error_bound, insisted.range_bound);
    EXPECT_TRUE(insisted.bound_says_nothing());
    EXPECT_LT(s.draw(Threshold(&s.indicator, 0.1)).error_bound, 1e9);
}

TEST(Criteria, ByLevelAreRefusedWhereNodesHaveSeveralLevels) {
    BisectionGrid<3> grid(shaken(tetrahedra(2), 2, 0.08));
    refine_at_sphere(grid, 9);
    const auto values = sample_nodes(grid, [](const Point& x) { return to_sphere(x, 3); });
    const NodeField<BisectionGrid<3>, double> field(grid, values);
    const HierarchicalIndicator indicator(grid, field);
    EXPECT_FALSE(indicator.one_level_a_node());
    const Threshold exact(&indicator, 0);
    for (const int level : {1, 4}) {
        const DeepestLevel deepest(level);
        expect_refused([&] { isosurface(grid, field, 0.0, under(deepest, indicator)); },
                       "NodeLevels");
        expect_refused([&] { isosurface(grid, field, 0.0, under(deepest || exact, indicator)); },
                       "NodeLevels");
    }
}

template <class Family>
class NodeLevelsOn : public testing::Test {};
TYPED_TEST_SUITE(NodeLevelsOn, Families);

TYPED_TEST(NodeLevelsOn, DrawClosedSurfacesAtEveryDepth) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const NodeLevels levels(grid);
        for (const NodalSamples& samples : catching_fields(grid.node_positions(), 5)) {
            const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
            const HierarchicalIndicator indicator(grid, field);
            std::size_t last = 0;
            for (int depth = 0; depth <= 3 * TypeParam::steps + 1; ++depth) {
                SCOPED_TRACE(samples.name + " at depth " + std::to_string(depth));
                const auto result =
                    isosurface(grid, field, 0.0, under(levels.deeper_than(depth), indicator));
                expect_closed(result.surface);
                last = result.surface.simplices.size();
                if (!indicator.one_level_a_node()) continue;
                // Where a node has one level, the level of the element says the same.
                const auto by_element =
                    isosurface(grid, field, 0.0, under(DeepestLevel(depth), indicator));
                EXPECT_EQ(result.surface.vertices, by_element.surface.vertices);
                EXPECT_EQ(result.surface.simplices, by_element.surface.simplices);
            }
            const auto whole = isosurface(grid, field, 0.0, under(Exact{}, indicator));
            EXPECT_EQ(last, whole.surface.simplices.size());
        }
    }
}

}  // namespace criteria_test
