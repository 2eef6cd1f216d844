// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Probes where the children's maps are no parts of their father's, in curved and partly hidden
// grids; lines, single points, and what is refused.
#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/adapters/octree_grid.hpp>
#include <nestgrid/algorithms/probe_line.hpp>
#include <nestgrid/rule_table.hpp>

#include "curved.hpp"
#include "families.hpp"
#include "hiding_forest.hpp"
#include "refusal.hpp"
#include "stopped_elements.hpp"

using namespace nestgrid_test;

namespace probe_cases_test {

double wave(const Point& x) { return std::sin(3 * x[0] + 1) * std::cos(4 * x[1]) + x[2] * x[0]; }

/// Probes points inside and between the stopped elements, and inside leaves.
template <class Grid, class Field>
void expect_probes(const Grid& grid, const Field& field, double threshold) {
    const HierarchicalIndicator indicator(grid, field);
    const Threshold criterion(&indicator, threshold);
    const auto stopped = stopped_elements(grid, field, criterion, indicator.hanging());
    const Expected in = inside(stopped, 1000, 1);
    expect_values(probe(grid, field, in.points, under(criterion, indicator)), in, stopped);
    const Expected on = between(stopped);
    expect_values(probe(grid, field, on.points, under(criterion, indicator)), on, stopped);
    const auto leaves = stopped_elements(grid, field, Exact{}, indicator.hanging());
    const Expected finest = inside(leaves, 300, 2);
    expect_values(probe(grid, field, finest.points), finest, leaves);
}

/// Closures divide deformed hexahedra into pyramids and tetrahedra, whose faces bend otherwise.
TEST(ProbeCases, DeformedHexahedraWithClosures) {
    for (const double amount : {0.02, 0.05}) {
        RedGreenGrid<3> grid(shaken(hexahedra(3), 6, amount));
        refine_at_sphere(grid, 3);
        const std::vector<double> values = sample_nodes(grid, wave);
        const NodeField<RedGreenGrid<3>, double> field(grid, values);
        for (const double threshold : {0.0, 0.05, 1.0}) expect_probes(grid, field, threshold);
    }
}

TEST(ProbeCases, DeformedBoxesWithHangingNodes) {
    std::mt19937 random(2);
    for (int i = 0; i < 5; ++i) {
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 60);
        expect_probes(forest, ForestField<3>(forest, wave), 0.05);
        Forest<2> plane = boxes<2>(random, 3);
        refine_randomly(plane, random, 60);
        expect_probes(plane, ForestField<2>(plane, wave), 0.05);
    }
}

/// Children in general position: their maps are inverted in the reference element of the father.
TEST(ProbeCases, TetrahedraInFourHexahedra) {
    const Point a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
    const std::array<Point, 4> corner{a, b, c, d};
    std::vector<PlacedChild> children;
    for (std::size_t i = 0; i < 4; ++i) {
        // Each corner with the middles around it.
        std::array<Point, 3> other;
        for (std::size_t k = 0; k < 3; ++k) other[k] = corner[(i + 1 + k) % 4];
        if (i % 2 == 1) std::swap(other[0], other[1]);
        const auto mean = [](auto... x) { return (1.0 / sizeof...(x)) * (x + ...); };
        const auto& [p, q, r] = other;
        const Point o = corner[i];
        children.push_back({Shape::hexahedron,
                            {o, mean(o, p), mean(o, q), mean(o, p, q), mean(o, r), mean(o, p, r),
                             mean(o, q, r), mean(o, p, q, r)}});
    }
    RuleTable rules;
    const Rule& four = rules.add(Shape::tetrahedron, children);
    Forest<3> forest = kuhn<3>(0);
    for (std::uint32_t e = 0; e < 6; ++e) forest.refine(e, four);
    for (std::uint32_t e = 6; e < 30; ++e) forest.refine(e, dyadic_rule(Shape::hexahedron));
    expect_probes(forest, ForestField<3>(forest, wave), 0.0);
    expect_probes(forest, ForestField<3>(forest, wave), 0.05);
}

TEST(ProbeCases, WeightedStencils) {
    Forest<2> forest = kuhn<2>(0);
    for (std::uint32_t e = 0; e < 2; ++e) forest.refine(e, thirds_rule());
    expect_probes(forest, ForestField<2>(forest, wave), 0.0);
}

/// True positions are projected with the data: points are sought where the elements are.
TEST(ProbeCases, CurvedElements) {
    std::mt19937 random(3);
    Forest<3> forest = boxes<3>(random, 2);
    const Rule& dyadic = dyadic_rule(Shape::hexahedron);
    for (std::uint32_t e = 0; e < 8 + 64; ++e) forest.refine(e, dyadic);
    for (std::uint32_t e = 8 + 64; e < 8 + 64 + 512; e += 5) forest.refine(e, dyadic);
    const CurvedGrid grid(forest);
    const CurvedField field(grid, wave);
    for (const double threshold : {0.0, 0.05, 1.0}) expect_probes(grid, field, threshold);
}

/// Quadrilaterals of a surface in space that are not plane: the points on them are found, those
/// above them are not, although their reference coordinates lie inside.
TEST(ProbeCases, BesideABentSurface) {
    CoarseGrid coarse = quadrilaterals(2);
    std::vector<Point> bent;
    for (std::size_t i = 0; i < coarse.nodes.size(); ++i) {
        const Point x = coarse.nodes[i];
        bent.push_back({x[0], x[1], 0.3 * x[0] * x[1] + 0.1 * x[0]});
    }
    coarse.nodes = Coordinates(bent);
    OctreeGrid<2> grid(std::move(coarse));
    refine_at_sphere(grid, 3);
    const std::vector<double> values = sample_nodes(grid, wave);
    const NodeField<OctreeGrid<2>, double> field(grid, values);
    expect_probes(grid, field, 0.05);
    const HierarchicalIndicator indicator(grid, field);
    std::vector<Point> above =
        inside(stopped_elements(grid, field, Exact{}, indicator.hanging()), 200, 5).points;
    for (Point& x : above) x[2] += 0.01;
    const ProbeResult result = probe(grid, field, above);
    for (std::size_t i = 0; i < above.size(); ++i) EXPECT_FALSE(result.found(i));
}

/// Points on the boundary of hidden elements are found in those beside them.
TEST(ProbeCases, BesideHiddenElements) {
    std::mt19937 random(4);
    for (int i = 0; i < 5; ++i) {
        Forest<3> forest = boxes<3>(random, 2);
        refine_randomly(forest, random, 40);
        const HidingForest<3> grid(forest, random);
        expect_probes(grid, ForestField<3>(grid, wave), 0.0);
    }
}

TEST(ProbeCases, LinesAndSinglePoints) {
    OctreeGrid<2> grid(quadrilaterals(2));
    refine_at_sphere(grid, 3);
    const auto f = [](const Point& x) { return static_cast<float>(x[0] + 2 * x[1]); };
    std::vector<float> values;
    for (const Point& x : grid.node_positions()) values.push_back(f(x));
    const NodeField<OctreeGrid<2>, float> field(grid, values);
    const LineProbe line = probe_line(grid, field, {0, 0.25, 0}, {2, 0.75, 0}, 5);
    ASSERT_EQ(line.points.size(), 5U);
    EXPECT_EQ(line.points.front(), (Point{0, 0.25, 0}));
    EXPECT_EQ(line.points.back(), (Point{2, 0.75, 0}));
    for (std::size_t i = 0; i < 5; ++i) {
        const Point& x = line.points[i];
        EXPECT_NEAR(line.distance[i], norm(x - line.points[0]), exact);
        ASSERT_EQ(line.found(i), i < 3);
        if (line.found(i)) {
            EXPECT_NEAR(line.values[i], x[0] + 2 * x[1], 1e-6);
        }
    }
    EXPECT_NEAR(probe_point(grid, field, {0.3, 0.4, 0})[0], 1.1, 1e-6);
    expect_refused(
        [&] {
            probe_point(grid, field, {0.3, 1.5, 0});
        },
        "the point (0.300000, 1.500000, 0.000000) lies outside the grid");
    const Hierarchy<float>& hierarchy = erase(grid, field);
    EXPECT_EQ(probe_point(hierarchy, {0.3, 0.4, 0}), probe_point(grid, field, {0.3, 0.4, 0}));
}

TEST(ProbeCases, RefuseWhatCannotBeProbed) {
    OctreeGrid<2> grid(quadrilaterals(1));
    refine_at_sphere(grid, 2);
    const std::vector<double> values = sample_nodes(grid, wave);
    const NodeField<OctreeGrid<2>, double> field(grid, values);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<Point> points{{0, 0, 0}, {0, nan, 0}};
    expect_refused([&] { probe(grid, field, points); }, "a coordinate of point 1 is not finite");
    expect_refused([&] { probe_line(grid, field, {0, 0, 0}, {1, 1, 0}, 1); }, "two points");
    const HierarchicalIndicator indicator(grid, field);
    const auto fine = std::span(points).first(1);
    EXPECT_TRUE(probe(grid, field, fine, under(Exact{}, indicator)).found(0));
    EXPECT_TRUE(probe(grid, field, std::span<const Point>{}).values.empty());
    grid.adapt([](const Leaf&) { return Mark::refine; });
    const std::vector<double> finer_values = sample_nodes(grid, wave);
    const NodeField<OctreeGrid<2>, double> finer(grid, finer_values);
    EXPECT_NE(refusal<GridError>([&] { probe(grid, finer, fine, under(Exact{}, indicator)); }), "");
}

}  // namespace probe_cases_test
