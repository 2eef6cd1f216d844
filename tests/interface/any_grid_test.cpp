// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The same surface, bit for bit, through the concept, AnyGrid and the C table.
#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/any_grid.hpp>
#include <nestgrid/check_grid.hpp>

#include "forest.hpp"
#include "sample_fields.hpp"

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
    EXPECT_EQ(a.surface.boundary, b.surface.boundary);
    EXPECT_EQ(a.counts.calls, b.counts.calls);
    EXPECT_EQ(a.counts.visited, b.counts.visited);
    EXPECT_EQ(a.counts.extracted, b.counts.extracted);
    EXPECT_EQ(a.error_bound, b.error_bound);
}

template <class Grid, class Field>
void expect_same_three_ways(const Grid& grid, const Field& field, double isovalue,
                            const IsosurfaceOptions& options) {
    using Real = typename Field::value_type;
    const auto direct = isosurface(grid, field, isovalue, options);
    const AnyGrid<Grid::dimension> any(grid);
    const AnyField<Real> any_field(grid, field);
    expect_same(direct, isosurface(any, any_field, isovalue, options));
    // The bridge is itself a model: a table of the erased grid, erased again.
    const nestgrid_grid table = make_table(any);
    const nestgrid_field field_table = make_table<AnyGrid<Grid::dimension>>(any_field);
    const AnyGrid<Grid::dimension> again(table);
    const AnyField<Real> field_again(field_table);
    expect_same(direct, isosurface(again, field_again, isovalue, options));
    EXPECT_FALSE(check_grid(any, any_field));
}

TEST(AnyGrid, GivesTheSameSurfaceOnLattices) {
    for (const Samples n : {Samples{17, 17, 17}, Samples{13, 18, 21}}) {
        const LatticeBisection<3> grid({.samples = n, .spacing = {0.5, 1, 2}});
        const SampledField data = sampled_fields(n)[1];
        const LatticeField field(grid, std::span<const float>(data.values));
        for (const double threshold : {0.0, 0.05}) {
            expect_same_three_ways(grid, field, data.isovalue,
                                   {.threshold = threshold, .normals = true, .cap = true});
        }
        std::vector<std::int32_t> bytes(data.values.size());
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            bytes[i] = static_cast<std::int32_t>(40 * data.values[i]);
        }
        const LatticeField whole(grid, std::span<const std::int32_t>(bytes));
        expect_same_three_ways(grid, whole, 40 * data.isovalue, {.threshold = 2});
    }
    const LatticeBisection<2> image({.samples = {40, 23}});
    std::vector<double> values;
    for (int y = 0; y < 23; ++y) {
        for (int x = 0; x < 40; ++x) values.push_back(std::hypot(x - 20.0, y - 11.0));
    }
    const LatticeField field(image, std::span<const double>(values));
    expect_same_three_ways(image, field, 8.5, {.threshold = 0.1});
}

TEST(AnyGrid, GivesTheSameSurfaceWithDerivedKeys) {
    Forest<3> forest = kuhn<3>(0);
    for (std::uint32_t e = 0; forest.cells.size() < 4000; ++e) {
        forest.refine(e, red_tetrahedron_rule());
    }
    const ForestField<3> field(forest, [](const Point& x) {
        return norm(x - Point{0.4, 0.5, 0.6});
    });
    expect_same_three_ways(forest, field, 0.3, {.normals = true, .cap = true});
}

int failing_count(const void*, std::size_t*) { return 7; }
int coarse_with(const void*, void*, std::size_t, nestgrid_coarse*) { return 0; }
int children_with(const void*, void*, const nestgrid_element*, nestgrid_element*) { return 0; }
int split_with(const void*, void*, const nestgrid_element*, int* rule) {
    *rule = 3;
    return 0;
}

nestgrid_grid small_table() {
    nestgrid_grid t{};
    t.size = sizeof(t);
    t.dimension = 3;
    t.coarse_count = failing_count;
    t.coarse = coarse_with;
    t.split = split_with;
    t.children = children_with;
    return t;
}

template <class Function>
std::string refusal(Function&& function) {
    try {
        function();
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

TEST(CTable, IsRefusedWithASentence) {
    const auto refused = [](auto change) {
        nestgrid_grid t = small_table();
        change(t);
        return refusal([&] { AnyGrid<3>{t}; });
    };
    EXPECT_EQ(refused([](auto&) {}), "");
    EXPECT_EQ(refused([](auto& t) { t.size = 40; }),
              "the table of the grid is too small: its size says 40 bytes");
    EXPECT_EQ(refused([](auto& t) { t.dimension = 2; }),
              "the table is of a grid of dimension 2, not 3");
    EXPECT_EQ(refused([](auto& t) { t.coarse = nullptr; }),
              "the table of the grid lacks the function 'coarse'");
    EXPECT_EQ(refused([](auto& t) { t.split = nullptr; }),
              "the table of the grid lacks the function 'split'");
    EXPECT_EQ(refused([](auto& t) { t.rule_count = 1; }), "the table of the grid lacks its rules");
    nestgrid_stencil stencil{2, {0, 1}, {0.5, 0.75}, 0};
    nestgrid_child child{NESTGRID_TETRAHEDRON, {0, 1, 2, 3}, 1};
    nestgrid_rule rule{"halves", NESTGRID_TETRAHEDRON, 1, &stencil, 1, &child};
    const auto with_rule = [&](auto& t) {
        t.rules = &rule;
        t.rule_count = 1;
    };
    EXPECT_EQ(refused(with_rule),
              "rule 'halves': new node 0 has weights that add up to 1.250000, not to 1");
    stencil.weight[1] = 0.5;
    child.corner[0] = 4;
    EXPECT_EQ(refused(with_rule),
              "rule 'halves': volume lost: the children hold 0.500000 of their father");
    child.shape = 12;
    EXPECT_EQ(refused(with_rule), "rule 'halves': the shape 12 does not exist");
    const AnyGrid<3> grid(small_table());
    EXPECT_EQ(refusal([&] { (void)grid.coarse_count(); }),
              "the operation 'coarse_count' of the grid failed with code 7");
    AnyContext context;
    EXPECT_EQ(refusal([&] { (void)grid.split({}, context); }), "split gave rule 3 of 0");
}

TEST(CTable, OfAFieldIsRefusedWithASentence) {
    const LatticeBisection<3> grid({.samples = {3, 3, 3}});
    const std::vector<float> values(27, 1.0F);
    const LatticeField field(grid, std::span<const float>(values));
    nestgrid_field table = make_table<LatticeBisection<3>>(field);
    EXPECT_NE(refusal([&] { AnyField<double>{table}; }).find("of another type"), std::string::npos);
    table.components = 2;
    EXPECT_EQ(refusal([&] { AnyField<float>{table}; }), "the field has 2 components, not 1");
    table.components = 1;
    table.new_values = nullptr;
    EXPECT_NE(refusal([&] { AnyField<float>{table}; }).find("lacks the function"),
              std::string::npos);
}

}  // namespace
