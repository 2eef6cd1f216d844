// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The same surface, bit for bit, through the concept, AnyGrid and the C table.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/any_grid.hpp>
#include <nestgrid/check_grid.hpp>

#include "archetype.hpp"
#include "curved.hpp"
#include "forest.hpp"
#include "identity.hpp"
#include "sample_fields.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

template <class A, class B>
void expect_same(const A& a, const B& b) {
    EXPECT_GT(a.surface.simplices.size(), 0U);
    EXPECT_EQ(a.surface.vertices, b.surface.vertices);
    EXPECT_EQ(a.surface.normals, b.surface.normals);
    EXPECT_EQ(a.surface.simplices, b.surface.simplices);
    EXPECT_EQ(a.surface.element_of, b.surface.element_of);
    EXPECT_EQ(a.surface.level_of, b.surface.level_of);
    EXPECT_EQ(a.surface.boundary, b.surface.boundary);
    EXPECT_EQ(a.counts.calls, b.counts.calls);
    EXPECT_EQ(a.counts.visited, b.counts.visited);
    EXPECT_EQ(a.counts.extracted, b.counts.extracted);
    EXPECT_EQ(a.error_bound, b.error_bound);
}

/// `rules` are all that the grid uses.
template <class Grid, class Field>
void expect_same_every_way(const Grid& grid, const Field& field, double isovalue,
                           const std::vector<const Rule*>& rules,
                           const IsosurfaceOptions& options) {
    using Real = typename Field::value_type;
    using Any = AnyGrid<Grid::dimension>;
    const auto direct = isosurface(grid, field, isovalue, options);
    const Any any(grid);
    const AnyField<Real> any_field(grid, field);
    {
        SCOPED_TRACE("AnyGrid");
        expect_same(direct, isosurface(any, any_field, isovalue, options));
    }
    {
        SCOPED_TRACE("the table of an AnyGrid: the bridge is itself a model");
        const nestgrid_grid table = make_table(any);
        const nestgrid_field field_table = make_table(any, any_field);
        const Any again(table);
        const AnyField<Real> field_again(field_table);
        expect_same(direct, isosurface(again, field_again, isovalue, options));
    }
    {
        SCOPED_TRACE("a table as written in C");
        const TableInC<Grid> in_c(grid, rules);
        const Any again(in_c.table);
        expect_same(direct, isosurface(again, any_field, isovalue, options));
        EXPECT_FALSE(check_grid(again, any_field));
    }
    EXPECT_FALSE(check_grid(any, any_field));
    EXPECT_EQ(epoch(any), epoch(grid));
    EXPECT_EQ(dense_key_count(any), dense_key_count(grid));
}

const std::vector<const Rule*>& tetrahedron_bisections() {
    static const std::vector<const Rule*> rules{&bisection_rule(Shape::tetrahedron, 1),
                                                &bisection_rule(Shape::tetrahedron, 2),
                                                &bisection_rule(Shape::tetrahedron, 3)};
    return rules;
}

template <class Sample>
std::vector<Sample> rounded(const std::vector<float>& values, float scale) {
    std::vector<Sample> result;
    for (const float v : values) result.push_back(static_cast<Sample>(scale * v));
    return result;
}

TEST(AnyGrid, GivesTheSameSurfaceOnLattices) {
    for (const Samples n : {Samples{17, 17, 17}, Samples{13, 18, 21}}) {
        const LatticeBisection<3> grid({.samples = n, .spacing = {0.5, 1, 2}});
        const SampledField data = sampled_fields(n)[0];
        const LatticeField field(grid, std::span<const float>(data.values));
        for (const double threshold : {0.0, 0.05}) {
            expect_same_every_way(grid, field, data.isovalue, tetrahedron_bisections(),
                                  {.threshold = threshold, .normals = true, .cap = true});
        }
        const auto bytes = rounded<std::uint8_t>(data.values, 40);
        const LatticeField coarse(grid, std::span<const std::uint8_t>(bytes));
        expect_same_every_way(grid, coarse, 15, tetrahedron_bisections(), {.cap = true});
        const auto words = rounded<std::int32_t>(data.values, 1000);
        const LatticeField whole(grid, std::span<const std::int32_t>(words));
        expect_same_every_way(grid, whole, 370, tetrahedron_bisections(), {.threshold = 50});
    }
}

TEST(AnyGrid, GivesTheSameLinesOnImages) {
    const LatticeBisection<2> image({.samples = {40, 23}});
    std::vector<double> values;
    for (int y = 0; y < 23; ++y) {
        for (int x = 0; x < 40; ++x) values.push_back(std::hypot(x - 20.0, y - 11.0));
    }
    const LatticeField field(image, std::span<const double>(values));
    for (const double threshold : {0.0, 0.1}) {
        expect_same_every_way(
            image, field, 11.5,
            {&bisection_rule(Shape::triangle, 1), &bisection_rule(Shape::triangle, 2)},
            {.threshold = threshold, .normals = true, .cap = true});
    }
}

double distance(const Point& x) { return norm(x - Point{0.4, 0.5, 0.6}); }

TEST(AnyGrid, GivesTheSameSurfaceFromTheRequiredOperations) {
    Forest<3> red = kuhn<3>(0);
    for (std::uint32_t e = 0; red.cells.size() < 4000; ++e) red.refine(e, red_tetrahedron_rule());
    const ForestField<3> field(red, distance);
    for (const double threshold : {0.0, 0.02}) {
        expect_same_every_way(red, field, 0.3, {&red_tetrahedron_rule()},
                              {.threshold = threshold, .normals = true, .cap = true});
    }
    const ArchetypeGrid archetype;
    expect_same_every_way(archetype, ArchetypeField{}, 3.0, {&bisection_rule(Shape::triangle, 2)},
                          {});
}

TEST(AnyGrid, GivesTheSameLinesWithUnequalWeights) {
    const Rule thirds = make_rule("thirds", Shape::triangle,
                                  {weighted_mean_of({{0, 2.0 / 3}, {1, 1.0 / 3}}),
                                   weighted_mean_of({{0, 0.5}, {2, 0.3}, {3, 0.2}}, 1)},
                                  {{Shape::triangle, {0, 3, 4}, 1, {}},
                                   {Shape::triangle, {3, 2, 4}, 1, {}},
                                   {Shape::triangle, {2, 0, 4}, 1, {}},
                                   {Shape::triangle, {3, 1, 2}, 1, {}}});
    Forest<2> forest = kuhn<2>(0);
    for (std::uint32_t e = 0; forest.cells.size() < 200; ++e) forest.refine(e, thirds);
    const ForestField<2> field(forest, [](const Point& x) { return norm(x); });
    expect_same_every_way(forest, field, 0.7, {&thirds}, {});
}

TEST(AnyGrid, GivesTheSameSurfaceWhereNodesHang) {
    std::mt19937 random(3);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 400);
    const ForestField<3> field(forest, distance);
    EXPECT_GT(derive_hanging_nodes(forest).size(), 0U);
    expect_same_every_way(forest, field, 0.3, tetrahedron_bisections(), {});
}

TEST(AnyGrid, PassesOnStateAndOptionalOperations) {
    using Task = CurvedGrid::Context;
    std::mt19937 random(4);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 400);
    const CurvedGrid grid(forest);
    const CurvedField field(grid, distance);
    const AnyGrid<3> any(grid);
    for (const Feature f : {Feature::own_keys, Feature::dense_keys, Feature::own_positions,
                            Feature::new_positions, Feature::constrained, Feature::masked,
                            Feature::hidden, Feature::outside, Feature::boundary_faces}) {
        EXPECT_EQ(offers(any, f), offers(grid, f)) << static_cast<unsigned>(f);
    }
    EXPECT_FALSE(grid.hanging.empty());
    EXPECT_EQ(epoch(any), 5U);
    EXPECT_EQ(any.node_count(), forest.positions.size());
    expect_same_every_way(grid, field, 0.3, tetrahedron_bisections(),
                          {.threshold = 0.01, .normals = true, .cap = true});
    EXPECT_GT(Task::uses, 0);
    EXPECT_EQ(Task::live, 0);
    const int before = Task::made;
    {
        const AnyContext one = any.make_context();
        const AnyContext two = any.make_context();
        EXPECT_NE(one.state(), two.state());
        EXPECT_EQ(Task::live, 2);
    }
    EXPECT_EQ(Task::live, 0);
    EXPECT_EQ(Task::made, before + 2);
}

TEST(AnyGrid, CopiesShareWhatTheyWereMadeOf) {
    const LatticeBisection<3> grid({.samples = {5, 6, 7}});
    const TableInC<LatticeBisection<3>> in_c(grid, tetrahedron_bisections());
    auto first = std::make_unique<AnyGrid<3>>(in_c.table);
    const AnyGrid<3> second = *first;
    AnyContext c = first->make_context();
    const auto coarse = first->coarse(0, c);
    const Rule* rule = first->split(coarse.element, c);
    first.reset();
    EXPECT_EQ(second.split(coarse.element, c), rule);
    EXPECT_EQ(rule->name, bisection_rule(Shape::tetrahedron, 3).name);
}

}  // namespace
