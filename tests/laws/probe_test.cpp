// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Values at points: those that the element around a point interpolates, on every family, for points
// inside elements, on their faces and edges, and at nodes.
#include <algorithm>
#include <cmath>
#include <set>

#include <walk/for_each_element.hpp>

#include "counting_allocator.hpp"
#include "families.hpp"
#include "stopped_elements.hpp"

using namespace nestgrid_test;

namespace probe_test {

template <class Family>
class Probes : public testing::Test {};
TYPED_TEST_SUITE(Probes, Families);

TYPED_TEST(Probes, AreWhatTheStoppedElementsInterpolate) {
    for_each_field_at_sphere<TypeParam>(3, 3, [](const auto& grid, const auto& samples) {
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : {0.0, 0.1, 1.0}) {
            SCOPED_TRACE(threshold);
            const Threshold criterion(&indicator, threshold);
            const auto stopped = stopped_elements(grid, field, criterion, indicator.hanging());
            const Expected in = inside(stopped, 1000, 5);
            expect_values_inside(probe(grid, field, in.points, under(criterion, indicator)), in);
            const Expected on = between(stopped);
            expect_values(probe(grid, field, on.points, under(criterion, indicator)), on, stopped);
        }
    });
}

TYPED_TEST(Probes, AreTheFinestDataWithoutACriterion) {
    for_each_field_at_sphere<TypeParam>(3, 4, [](const auto& grid, const auto& samples) {
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const auto leaves = stopped_elements(grid, field, Exact{}, indicator.hanging());
        const Expected in = inside(leaves, 300, 6);
        expect_values_inside(probe(grid, field, in.points), in);
        const Expected on = between(leaves);
        expect_values(probe(grid, field, on.points), on, leaves);
    });
}

TYPED_TEST(Probes, FindALinearFunctionAtEveryThreshold) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 3 * TypeParam::steps);
        const auto f = [](const Point& x) { return 2 * x[0] - 3 * x[1] + x[2] + 0.125; };
        const std::vector<double> values = sample_nodes(grid, f);
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        const auto leaves = stopped_elements(grid, field, Exact{}, indicator.hanging());
        const std::vector<Point> points = inside(leaves, 1000, 7).points;
        for (const double threshold : {0.0, 0.1, 1.0}) {
            const Threshold criterion(&indicator, threshold);
            const auto result = probe(grid, field, points, under(criterion, indicator));
            for (std::size_t i = 0; i < points.size(); ++i) {
                EXPECT_NEAR(result.values[i], f(points[i]), exact);
            }
        }
    }
}

/// The grids fill the unit cube or square, but for the octahedron, which has an inside and an
/// outside, too.
TYPED_TEST(Probes, FindNothingOutside) {
    for (auto& grid : TypeParam::grids()) {
        refine_at_sphere(grid, 2 * TypeParam::steps);
        const std::vector<double> values = sample_nodes(grid, [](const Point&) { return 1.0; });
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        std::mt19937 random(8);
        std::vector<Point> points;
        while (points.size() < 500) {
            Point x;
            for (double& at : x) at = 5 * uniform(random) - 2;
            const bool in_cube =
                *std::ranges::min_element(x) > -1e-6 && *std::ranges::max_element(x) < 1 + 1e-6;
            const bool on_octahedron =
                std::abs(std::abs(x[0]) + std::abs(x[1]) + std::abs(x[2]) - 1) < 1e-3;
            if (!in_cube && !on_octahedron) points.push_back(x);
        }
        for (const double off : {1.00001, 1.01}) points.push_back({off, 0.3, 0.4});
        const ProbeResult result = probe(grid, field, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_FALSE(result.found(i)) << text_of(points[i]);
            EXPECT_TRUE(std::isnan(result.values[i]));
        }
    }
}

TYPED_TEST(Probes, DoNotDependOnTheOrderOfPoints) {
    for_each_field_at_sphere<TypeParam>(2, 9, [](const auto& grid, const auto& samples) {
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, samples.values);
        const HierarchicalIndicator indicator(grid, field);
        const Threshold criterion(&indicator, 0.1);
        const auto stopped = stopped_elements(grid, field, criterion, indicator.hanging());
        const std::vector<Point> points = between(stopped).points;
        std::vector<std::size_t> order(points.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::mt19937 random(10);
        std::shuffle(order.begin(), order.end(), random);
        std::vector<Point> shuffled;
        for (const std::size_t i : order) shuffled.push_back(points[i]);
        const auto expected = probe(grid, field, points, under(criterion, indicator));
        const auto result = probe(grid, field, shuffled, under(criterion, indicator));
        for (std::size_t i = 0; i < order.size(); ++i) {
            EXPECT_EQ(result.values[i], expected.values[order[i]]);
            EXPECT_EQ(result.level[i], expected.level[order[i]]);
        }
    });
}

/// Calls test(grid, field, bounds, leaves) for grids of a family that are refined at the sphere,
/// with the distance from the origin as a field.
template <class Family, class Test>
void for_each_distance(int levels, Test&& test) {
    for (auto& grid : Family::grids()) {
        refine_at_sphere(grid, levels * Family::steps);
        const std::vector<double> values =
            sample_nodes(grid, [](const Point& x) { return norm(x); });
        const NodeField<std::decay_t<decltype(grid)>, double> field(grid, values);
        const HierarchicalIndicator indicator(grid, field);
        test(grid, field, indicator, stopped_elements(grid, field, Exact{}, indicator.hanging()));
    }
}

/// One call a level; where children are no parts of the map of a deformed father, points go down
/// twice, the second time beside their elements, too.
TYPED_TEST(Probes, VisitOneElementALevel) {
    constexpr bool may_go_twice = std::is_same_v<TypeParam, RedGreenMixed2>;
    for_each_distance<TypeParam>(
        4, [&](const auto& grid, const auto& field, const auto& /*indicator*/, const auto& leaves) {
            const Expected in = inside(leaves, 200, 11);
            const ProbeResult result = probe(grid, field, in.points);
            std::uint64_t most = 0;
            for (const int level : in.levels) most += static_cast<std::uint64_t>(level) + 1;
            EXPECT_LE(result.counts.calls, may_go_twice ? 8 * most : most);
            EXPECT_LE(result.counts.visited, result.counts.calls);
            EXPECT_LE(result.counts.extracted, result.counts.visited);
        });
}

/// Rounding puts points on faces and edges outside of all children. They go down all the same, and
/// need no second descent.
TYPED_TEST(Probes, GoDownOnceBetweenElements) {
    if constexpr (!std::is_same_v<TypeParam, RedGreenMixed2>) {
        for_each_distance<TypeParam>(
            3, [&](const auto& grid, const auto& field, const auto& indicator, const auto& leaves) {
                const Expected on = between(leaves);
                for (std::size_t i = 0; i < on.points.size(); i += 1 + on.points.size() / 500) {
                    const auto point = std::span(on.points).subspan(i, 1);
                    const ProbeResult result = probe(grid, field, point, under(Exact{}, indicator));
                    EXPECT_LE(result.counts.calls, static_cast<std::uint64_t>(result.level[0]) + 1)
                        << text_of(point[0]);
                }
            });
    }
}

template <class Grid, class Field>
std::size_t count_rules(const Grid& grid, const Field& field) {
    const auto hierarchy = erase(grid, field);
    const engine::Walk<double> walk(hierarchy, {.values = false});
    std::set<const Rule*> rules;
    engine::for_each_element<double>(
        walk, true, [&](const auto&, const engine::Split& split) { rules.insert(split.rule); });
    return rules.size();
}

/// Memory comes in vectors that are kept, a few for each level and each rule.
TYPED_TEST(Probes, AllocateForLevelsAndNotForElements) {
    for_each_distance<TypeParam>(
        4, [&](const auto& grid, const auto& field, const auto& indicator, const auto& leaves) {
            const auto allocations = [&](std::size_t count) {
                const std::vector<Point> points = inside(leaves, count, 12).points;
                const std::size_t before = allocation_count();
                EXPECT_TRUE(probe(grid, field, points, under(Exact{}, indicator)).found(0));
                return allocation_count() - before;
            };
            const std::size_t few = allocations(500);
            EXPECT_LT(allocations(5000), few + 200 + 30 * count_rules(grid, field));
        });
}

}  // namespace probe_test
