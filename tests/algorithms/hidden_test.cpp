// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Hidden elements: nothing is drawn in them, and beside them what would be drawn without, of data
// that are interpolated at the nodes of hidden leaves alone.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/discontinuous.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/shading.hpp>
#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/check_grid.hpp>
#include <walk/project.hpp>

#include "closedness.hpp"
#include "hiding_forest.hpp"
#include "table_in_c.hpp"
#include "thread_executor.hpp"

using namespace nestgrid_test;

namespace hidden_test {

/// The simplices of elements that are shown, by the positions of their corners.
template <int dim>
std::vector<Point> shown(const HidingForest<dim>& grid, const Surface<dim>& surface) {
    std::vector<Point> corners;
    const auto elements = surface.elements.template as<typename HidingForest<dim>::Element>();
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        if (grid.hidden(elements[surface.element_of[t]]) != Hidden::not_at_all) continue;
        for (const auto v : surface.simplices[t]) corners.push_back(surface.vertices[v]);
    }
    return corners;
}

template <int dim>
void expect_the_rest_unchanged(Forest<dim> forest, int steps) {
    std::mt19937 random(7);
    refine_randomly(forest, random, steps);
    HidingForest<dim> grid(std::move(forest), random);
    std::size_t simplices = 0;
    std::size_t hidden = 0;
    for (const NodalSamples& samples : catching_fields(grid.positions, 11)) {
        SCOPED_TRACE(samples.name);
        ForestField<dim> field(grid, [](const Point&) { return 0.0; });
        field.values = samples.values;
        grid.fill_unseen(field.values);
        const auto violation = check_grid(grid, field, CheckOptions{.hanging_values = false});
        ASSERT_FALSE(violation) << violation->sentence;
        const HierarchicalIndicator indicator(grid, field);
        for (const double threshold : six_thresholds) {
            SCOPED_TRACE(threshold);
            const IsosurfaceOptions options{.verify = true};
            const auto surface =
                isosurface(grid, field, 0.0, under(indicator, threshold), options).surface;
            grid.draws_all = true;
            const auto all =
                isosurface(grid, field, 0.0, under(indicator, threshold), options).surface;
            grid.draws_all = false;
            std::vector<Point> corners;
            for (const auto& s : surface.simplices) {
                for (const auto v : s) corners.push_back(surface.vertices[v]);
            }
            ASSERT_EQ(shown(grid, surface), corners);  // nothing else is drawn
            ASSERT_EQ(shown(grid, all), corners);
            simplices += surface.simplices.size();
            hidden += all.simplices.size() - surface.simplices.size();

            const BehindTables tables(grid, field);
            const auto told =
                isosurface<dim>(*tables.hierarchy, 0.0, under(indicator, threshold), options)
                    .surface;
            EXPECT_EQ(told.simplices, surface.simplices);
            EXPECT_EQ(told.vertices, surface.vertices);
            const auto in_threads = isosurface(grid, field, 0.0, under(indicator, threshold),
                                               options, {ThreadExecutor(3)})
                                        .surface;
            EXPECT_EQ(in_threads.simplices, surface.simplices);
            EXPECT_EQ(in_threads.vertices, surface.vertices);
        }
    }
    EXPECT_GT(simplices, 1000U);
    EXPECT_GT(hidden, 100U);
}

TEST(Hidden, ElementsDoNotChangeWhatIsDrawnBesideThem) {
    std::mt19937 random(3);
    expect_the_rest_unchanged(boxes<3>(random, 2), 60);
    expect_the_rest_unchanged(kuhn<3>(3), 1500);
    expect_the_rest_unchanged(kuhn<3>(0), 150);
    expect_the_rest_unchanged(boxes<2>(random, 3), 200);
    expect_the_rest_unchanged(kuhn<2>(2), 500);
}

/// Also where there are more hidden elements than triangles.
TEST(Hidden, ElementsAreNotCounted) {
    std::mt19937 random(9);
    Forest<2> forest = boxes<2>(random, 3);
    refine_randomly(forest, random, 200);
    const HidingForest<2> grid(std::move(forest), random, 3);
    const ForestField<2> field(grid, [](const Point& x) { return std::sin(5 * x[0] * x[1]); });
    const HierarchicalIndicator indicator(grid, field);
    for (const double threshold : six_thresholds) {
        const Threshold criterion(&indicator, threshold);
        const std::uint64_t drawn =
            shading(grid, field, under(criterion, indicator)).surface.simplices.size();
        EXPECT_GT(drawn, 0U);
        EXPECT_EQ(count_triangles({grid, field}, under(criterion, indicator), drawn), drawn);
    }
}

/// Elements that are drawn alone stop where nothing below them is hidden.
TEST(Hidden, ElementsAreNotDrawnAlone) {
    std::mt19937 random(5);
    for (int i = 0; i < 10; ++i) {
        Forest<2> forest = i % 2 == 0 ? boxes<2>(random, 3) : kuhn<2>(2);
        refine_randomly(forest, random, 200);
        const HidingForest<2> grid(std::move(forest), random);
        const auto one = [](std::uint32_t) { return 1.0; };
        const DiscontinuousData data(grid, one);
        const Surface<3> leaves = shading(data).surface;
        const Surface<3> some = shading(data, {.threshold = 1}).surface;
        EXPECT_LT(some.level_of.size(), leaves.level_of.size());
        const double area = surface_report(leaves).area;
        EXPECT_NEAR(surface_report(some).area, area, 1e-12 * area);
        for (const Surface<3>* drawn : {&leaves, &some}) {
            for (const std::uint32_t e : drawn->elements.as<std::uint32_t>()) {
                EXPECT_EQ(grid.hidden(e), Hidden::not_at_all);
            }
        }
    }
}

/// Not even through the projection, and not where a hidden leaf is coarser.
TEST(Hidden, LeavesConstrainNoNode) {
    Forest<2> forest;
    for (const Point& x : {Point{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}) {
        forest.add_node(x);
    }
    forest.add_coarse(Shape::quadrilateral, {0, 1, 3, 4}, 1);
    forest.add_coarse(Shape::quadrilateral, {1, 2, 4, 5}, 1);
    forest.refine(0, dyadic_rule(Shape::quadrilateral));
    EXPECT_EQ(derive_hanging_nodes(forest).size(), 1U);
    bool found = false;
    for (unsigned seed = 0; seed < 100 && !found; ++seed) {  // until leaf 1 alone is hidden
        std::mt19937 random(seed);
        const HidingForest<2> grid(forest, random);
        if (grid.hidden(0) != Hidden::not_at_all || grid.hidden(1) != Hidden::wholly) continue;
        found = true;
        EXPECT_EQ(derive_hanging_nodes(grid).size(), 0U);
        const ForestField<2> field(grid, [](const Point& x) { return x[0]; });
        const auto hierarchy = erase(grid, field);
        const engine::Walk<double> walk(hierarchy, {.keys = true});
        std::size_t leaves = 0;
        engine::project(walk, Exact{}, [&](const auto&) { ++leaves; });
        EXPECT_EQ(leaves, 4U);
    }
    EXPECT_TRUE(found);
}

}  // namespace hidden_test
