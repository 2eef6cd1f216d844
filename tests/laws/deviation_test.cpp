// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A threshold on deviations is the error: |U - P_S U| <= epsilon at all nodes, which a threshold on
// offsets does not promise. By brute force, on every family.
#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "families.hpp"
#include "kept_elements.hpp"
#include "projection_judge.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace deviation_test {

constexpr double bfloat16_steps = 1 + 1.0 / 128;  // numbers are rounded up by less
constexpr std::array<double, 7> all_thresholds{0, 0.01, 0.05, 0.2, 0.5, 1, 2};

/// By node, the greatest deviation of the elements whose split makes it: all nodes below each
/// element are compared with its interpolant.
std::map<NodeKey, double> deviations(const std::vector<KeptElement>& splits) {
    std::map<NodeKey, double> greatest;
    for (std::size_t i = 0; i < splits.size(); ++i) {
        const auto corners = static_cast<std::size_t>(splits[i].rule->corner_count());
        std::map<NodeKey, double> z;
        for (std::size_t k = 0; k < corners; ++k) z[splits[i].keys[k]] = splits[i].values[k];
        double deviation = 0;
        for (std::size_t j = i; j < splits.size() && (j == i || splits[j].level > splits[i].level);
             ++j) {
            const KeptElement& below = splits[j];
            const auto first = static_cast<std::size_t>(below.rule->corner_count());
            for (std::size_t n = 0; n < below.rule->new_nodes.size(); ++n) {
                const Stencil& stencil = below.rule->new_nodes[n];
                double mean = 0;
                for (std::size_t p = 0; p < stencil.count; ++p) {
                    mean += stencil.weight[p] * z.at(below.keys[stencil.parent[p]]);
                }
                z[below.keys[first + n]] = mean;
                deviation = std::max(deviation, std::abs(below.values[first + n] - mean));
            }
        }
        for (std::size_t n = corners; n < splits[i].keys.size(); ++n) {
            double& at = greatest[splits[i].keys[n]];
            at = std::max(at, deviation);
        }
    }
    return greatest;
}

template <class Family>
class Deviation : public testing::Test {};
TYPED_TEST_SUITE(Deviation, Families);

TYPED_TEST(Deviation, OfNodesIsTheGreatestDifferenceToAnInterpolant) {
    for_each_field_at_sphere<TypeParam>(3, 4, [](const auto& grid, const auto& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h, NodeError::deviation);
        for (const auto& [node, deviation] : deviations(splits_of(h))) {
            EXPECT_GE(indicator.bound(node), deviation * (1 - 1e-14));
            EXPECT_LE(indicator.bound(node), deviation * bfloat16_steps + 1e-14);
            EXPECT_GE(indicator.stop(node), indicator.bound(node));
        }
        expect_saturated(h, indicator);
    });
}

TYPED_TEST(Deviation, ThatStopsIsTheErrorAtMost) {
    for_each_field_at_sphere<TypeParam>(3, 5, [](const auto& grid, const auto& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h, NodeError::deviation);
        const ProjectedNodes exact(h, Exact(), 0.0);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            const Threshold s(&indicator, threshold);
            const ProjectedNodes projected(h, s, 0.0);
            const double error = projected.difference(exact);
            EXPECT_LE(error, threshold);
            EXPECT_EQ(projected.interpolated_corners(), 0U);
            const ProjectedNodes blended(h, Blended(&indicator, threshold, 1.5), 0.0);
            EXPECT_LE(blended.difference(exact), 1.5 * threshold);
        }
    });
}

TYPED_TEST(Deviation, BoundsTheErrorOfClosedSurfaces) {
    for_each_field_at_sphere<TypeParam>(3, 6, [](const auto& grid, const auto& samples) {
        constexpr int dimension = TypeParam::Grid::dimension;
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator indicator(h, NodeError::deviation);
        const ProjectedNodes exact(h, Exact(), 0.0);
        for (const double threshold : all_thresholds) {
            SCOPED_TRACE(threshold);
            const auto result = isosurface<dimension>(h, 0.0, under(indicator, threshold));
            expect_closed(result.surface);
            const ProjectedNodes projected(h, Threshold(&indicator, threshold), 0.0);
            // On what is drawn the data are no further from the level than anywhere.
            const double where_drawn =
                std::min(projected.difference_where_drawn(exact), result.range_bound);
            EXPECT_GE(result.error_bound, where_drawn * (1 - 1e-14));
            const bool simplices = h.facts().only_shape == Shape::tetrahedron ||
                                   h.facts().only_shape == Shape::triangle;
            if (simplices) {
                EXPECT_LE(result.error_bound, threshold);
            }
        }
    });
}

TYPED_TEST(Deviation, DependsNeitherOnThreadsNorOnTheOrder) {
    for_each_field_at_sphere<TypeParam>(2, 7, [](const auto& grid, const auto& samples) {
        const NodeField<typename TypeParam::Grid, double> field(grid, samples.values);
        const auto h = erase(grid, field);
        const HierarchicalIndicator one(h, NodeError::deviation);
        for (const std::size_t threads : {2U, 5U}) {
            const HierarchicalIndicator many(h, NodeError::deviation, ThreadExecutor(threads));
            for (const KeptElement& split : splits_of(h)) {
                for (const NodeKey node : split.keys) {
                    EXPECT_EQ(many.stop(node), one.stop(node));
                    EXPECT_EQ(many.bound(node), one.bound(node));
                }
            }
        }
    });
}

TYPED_TEST(Deviation, IsMadeAnewWhereValuesChange) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        auto fields = catching_fields(grid.node_positions(), 8);
        std::vector<double> values = fields.front().values;
        const NodeField<typename TypeParam::Grid, double> field(grid, values);
        HierarchicalIndicator indicator(grid, field, NodeError::deviation);
        values = fields.back().values;
        indicator.update(grid, field, [](std::span<const Point>) { return true; });
        const HierarchicalIndicator anew(grid, field, NodeError::deviation);
        for (const KeptElement& split : splits_of(erase(grid, field))) {
            for (const NodeKey node : split.keys) {
                EXPECT_EQ(indicator.stop(node), anew.stop(node));
                EXPECT_EQ(indicator.bound(node), anew.bound(node));
            }
        }
    }
}

/// On a lattice, whose rows of nodes make them.
template <int dim>
void expect_exact_on_lattice(const std::array<int, dim>& samples) {
    const LatticeBisection<dim> grid({.samples = samples});
    std::mt19937 random(11);
    std::size_t count = 1;
    for (const int n : samples) count *= static_cast<std::size_t>(n);
    for (const bool noise : {true, false}) {
        std::vector<double> values(count);
        for (std::size_t i = 0; i < count; ++i) {
            values[i] = noise ? uniform(random) : std::sin(0.01 * static_cast<double>(i));
        }
        const LatticeField field(grid, std::span<const double>(values));
        const auto h = erase(grid, field);
        ASSERT_TRUE(h.facts().knows_stars);
        const HierarchicalIndicator indicator(h, NodeError::deviation);
        for (const auto& [node, deviation] : deviations(splits_of(h))) {
            EXPECT_GE(indicator.bound(node), deviation);
            // Elements beyond the domain count where a lattice is padded.
            if (grid.whole()) {
                EXPECT_LE(indicator.bound(node), deviation * bfloat16_steps + 1e-14);
            }
        }
        expect_saturated(h, indicator);
        const HierarchicalIndicator spread(h, NodeError::deviation, SequentialExecutor{},
                                           {.factor = 1.5});
        expect_saturated(h, spread);
        const ProjectedNodes exact(h, Exact(), 0.5);
        for (const double threshold : {0.0, 0.02, 0.2, 0.6}) {
            const ProjectedNodes projected(h, Threshold(&indicator, threshold), 0.5);
            EXPECT_LE(projected.difference(exact), threshold);
        }
        const HierarchicalIndicator many(h, NodeError::deviation, ThreadExecutor(3));
        for (NodeKey node = 0; node < h.facts().node_count; ++node) {
            EXPECT_EQ(many.stop(node), indicator.stop(node));
            EXPECT_EQ(many.bound(node), indicator.bound(node));
        }
    }
}

TEST(Deviation, IsExactOnLattices) {
    expect_exact_on_lattice<3>({17, 17, 17});
    expect_exact_on_lattice<3>({9, 17, 25});
    expect_exact_on_lattice<2>({33, 17});
    expect_exact_on_lattice<3>({11, 17, 14});
    expect_exact_on_lattice<2>({20, 13});
}

}  // namespace deviation_test
