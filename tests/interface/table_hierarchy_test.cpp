// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The same surface, bit for bit, by the concepts and by tables in C.
#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/check_grid.hpp>
#include <nestgrid/table.hpp>

#include "anisotropic_grids.hpp"
#include "anisotropic_judge.hpp"
#include "archetype.hpp"
#include "curved.hpp"
#include "forest.hpp"
#include "identity.hpp"
#include "refusal.hpp"
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

/// With a preroll, at any threshold, in the way of any hierarchy.
template <int dimension, class Real>
Isosurface<dimension> draw_by_offsets(const Hierarchy<Real>& hierarchy, double isovalue,
                                      double threshold, const IsosurfaceOptions& options) {
    const HierarchicalIndicator offsets(hierarchy);
    return isosurface<dimension>(hierarchy, isovalue, under(offsets, threshold), options);
}

template <class Grid, class Field>
void expect_same_behind_tables(const Grid& grid, const Field& field, double isovalue,
                               double threshold, const IsosurfaceOptions& options = {}) {
    const BehindTables tables(grid, field);
    constexpr int dimension = Grid::dimension;
    expect_same(draw_by_offsets<dimension>(erase(grid, field), isovalue, threshold, options),
                draw_by_offsets<dimension>(*tables.hierarchy, isovalue, threshold, options));
    const nestgrid_field field_table = field_in_c(grid, field);
    std::array<char, 300> message{};
    const int verdict = nestgrid_check_grid(&tables.table.table, &field_table, message.data(), 300);
    EXPECT_EQ(verdict != 0, check_grid(grid, field).has_value()) << message.data();
    const auto direct = erase(grid, field);
    EXPECT_EQ(tables.hierarchy->epoch(), direct.epoch());
    EXPECT_EQ(tables.hierarchy->facts().features, direct.facts().features);
    EXPECT_EQ(tables.hierarchy->facts().node_count, direct.facts().node_count);
    EXPECT_EQ(tables.hierarchy->facts().conforming, direct.facts().conforming);
}

template <class Sample>
std::vector<Sample> rounded(const std::vector<float>& values, float scale) {
    std::vector<Sample> result;
    for (const float v : values) result.push_back(static_cast<Sample>(scale * v));
    return result;
}

TEST(Tables, GiveTheSameSurfaceOnLattices) {
    for (const Samples n : {Samples{17, 17, 17}, Samples{13, 18, 21}}) {
        const LatticeBisection<3> grid({.samples = n, .spacing = {0.5, 1, 2}});
        const SampledField data = sampled_fields(n)[0];
        const LatticeField field(grid, std::span<const float>(data.values));
        for (const double threshold : {0.0, 0.05}) {
            expect_same_behind_tables(grid, field, data.isovalue, threshold,
                                      {.normals = true, .cap = true});
        }
        const auto bytes = rounded<std::uint8_t>(data.values, 40);
        const LatticeField coarse(grid, std::span<const std::uint8_t>(bytes));
        expect_same_behind_tables(grid, coarse, 15, 0, {.cap = true});
        const auto words = rounded<std::int32_t>(data.values, 1000);
        const LatticeField whole(grid, std::span<const std::int32_t>(words));
        expect_same_behind_tables(grid, whole, 370, 50);
    }
}

TEST(Tables, GiveTheSameLinesOnImages) {
    const LatticeBisection<2> image({.samples = {40, 23}});
    std::vector<double> values;
    for (int y = 0; y < 23; ++y) {
        for (int x = 0; x < 40; ++x) values.push_back(std::hypot(x - 20.0, y - 11.0));
    }
    const LatticeField field(image, std::span<const double>(values));
    for (const double threshold : {0.0, 0.1}) {
        expect_same_behind_tables(image, field, 11.5, threshold, {.normals = true, .cap = true});
    }
}

double distance(const Point& x) { return norm(x - Point{0.4, 0.5, 0.6}); }

TEST(Tables, GiveTheSameSurfaceFromTheRequiredOperations) {
    Forest<3> red = kuhn<3>(0);
    for (std::uint32_t e = 0; red.cells.size() < 4000; ++e) red.refine(e, red_tetrahedron_rule());
    const ForestField<3> field(red, distance);
    for (const double threshold : {0.0, 0.02}) {
        expect_same_behind_tables(red, field, 0.3, threshold, {.normals = true, .cap = true});
    }
    const ArchetypeGrid archetype;
    expect_same_behind_tables(archetype, ArchetypeField{}, 3.0, 0);
}

TEST(Tables, GiveTheSameLinesWithUnequalWeights) {
    static const Rule layers = make_rule(
        "layers", Shape::quadrilateral,
        {weighted_mean_of({{0, 0.75}, {2, 0.25}}), weighted_mean_of({{1, 0.75}, {3, 0.25}})},
        {Child{.shape = Shape::quadrilateral, .corner = {0, 1, 4, 5}},
         Child{.shape = Shape::quadrilateral, .corner = {4, 5, 2, 3}}});
    Forest<2> forest;
    for (const Point& x : topology(Shape::quadrilateral).reference) forest.add_node(x);
    forest.add_coarse(Shape::quadrilateral, {0, 1, 2, 3}, 1);
    for (std::uint32_t e = 0; forest.cells.size() < 200; ++e) forest.refine(e, layers);
    const ForestField<2> field(forest, [](const Point& x) { return norm(x); });
    expect_same_behind_tables(forest, field, 0.7, 0);
}

TEST(Tables, GiveTheSameSurfaceWhereNodesHang) {
    std::mt19937 random(3);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 400);
    const ForestField<3> field(forest, distance);
    EXPECT_GT(derive_hanging_nodes(forest).size(), 0U);
    expect_same_behind_tables(forest, field, 0.3, 0);
}

TEST(Tables, GiveTheSameSurfaceWhereParentsAreGiven) {
    int crossing = 0;
    for (unsigned seed = 0; crossing < 5; ++seed) {
        std::mt19937 random(seed);
        const Forest<3> forest = random_anisotropic_grid(random);
        const Judge judge(forest, random, true);
        if (!judge.supports() || judge.has_one_stencil()) continue;
        ++crossing;
        const ParentsByPlace grid(forest);
        const ForestField<3> field(forest, distance);
        expect_same_behind_tables(grid, field, 0.8, 0.01);
        TableInC failing(grid);
        failing.table.hanging_parents = [](const void*, std::uint64_t, std::uint64_t*) {
            return 7;
        };
        failing.table.last_error = nullptr;
        const auto hierarchy = open_table<double>(failing.table, field_in_c(grid, field));
        EXPECT_EQ(refusal<GridError>([&] { HierarchicalIndicator indicator(*hierarchy); }),
                  "the operation 'hanging_parents' of the grid failed with code 7");
    }
}

TEST(Tables, PassOnStateAndOptionalOperations) {
    using State = CurvedGrid::Context;
    std::mt19937 random(4);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 400);
    const CurvedGrid grid(forest);
    const CurvedField field(grid, distance);
    EXPECT_FALSE(grid.hanging.empty());
    EXPECT_EQ(BehindTables(grid, field).hierarchy->epoch(), 5U);
    expect_same_behind_tables(grid, field, 0.3, 0.01, {.normals = true, .cap = true});
    EXPECT_GT(State::uses, 0);
    EXPECT_EQ(State::live, 0);
    const BehindTables tables(grid, field);
    const int before = State::made;
    {
        const auto one = tables.hierarchy->open();
        const auto two = tables.hierarchy->open();
        EXPECT_EQ(State::live, 2);
    }
    EXPECT_EQ(State::live, 0);
    EXPECT_EQ(State::made, before + 2);
}

/// A velocity, whose first component is drawn and whose others are attributes.
struct Velocity : ForestField<3> {
    using ForestField<3>::ForestField;
    static constexpr int components = 3;

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<double, max_corners> u;
        (void)ForestField<3>::coarse_values(i, std::span(u).first(out.size() / 3));
        spread(u.data(), out);
        return 0;
    }
    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out) const {
        std::array<double, max_new_nodes> u;
        (void)ForestField<3>::new_values(e, which, std::span(u).first(out.size() / 3));
        spread(u.data(), out);
        return 0;
    }
    static void spread(const double* u, std::span<double> out) {
        for (std::size_t k = 0; k < out.size(); ++k) {
            out[k] = (1.0 + static_cast<double>(k % 3)) * u[k / 3];
        }
    }
};

TEST(Tables, GiveAsManyComponentsAsTheySay) {
    Forest<3> red = kuhn<3>(0);
    for (std::uint32_t e = 0; red.cells.size() < 1000; ++e) red.refine(e, red_tetrahedron_rule());
    const Velocity field(red, distance);
    const BehindTables tables(red, field);
    const auto direct = isosurface(red, field, 0.3);
    const auto behind = isosurface<3>(*tables.hierarchy, 0.3);
    EXPECT_FALSE(direct.surface.attributes.empty());
    EXPECT_EQ(direct.surface.attributes, behind.surface.attributes);
}

/// Regions and levels of nodes ask for no field.
TEST(Tables, OfGridsAloneAreHierarchies) {
    const LatticeBisection<3> grid({.samples = {5, 6, 7}});
    const TableInC table(grid);
    const auto inside = [](const Point& x) { return norm(x - Point{2, 2, 3}) < 2; };
    const Region direct(grid, inside);
    const Region behind(*open_table(table.table), inside);
    std::size_t count = 0;
    for (NodeKey node = 0; node < grid.node_count(); ++node) {
        EXPECT_EQ(direct.contains(node), behind.contains(node));
        count += behind.contains(node) ? 1 : 0;
    }
    EXPECT_GT(count, 0U);
    EXPECT_LT(count, grid.node_count());
}

TEST(Tables, OfAnotherDimensionAreRefused) {
    const LatticeBisection<3> grid({.samples = {5, 5, 5}});
    const std::vector<float> values(125);
    const LatticeField field(grid, std::span<const float>(values));
    const BehindTables tables(grid, field);
    EXPECT_EQ(refusal<InvalidInput>([&] { (void)isosurface<2>(*tables.hierarchy, 0.5); }),
              "the hierarchy has dimension 3, not 2");
}

}  // namespace
