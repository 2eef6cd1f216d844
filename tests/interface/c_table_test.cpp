// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables that are wrong, operations that fail, and what crosses a table.
#include <cstddef>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/table.hpp>

#include "archetype.hpp"
#include "curved.hpp"
#include "refusal.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace {

class CTable : public ::testing::Test {
protected:
    template <class Change>
    std::string refused(Change change) {
        nestgrid_grid t = table.table;
        change(t);
        return refusal<InvalidInput>([&] { open_table(t); });
    }
    ArchetypeGrid grid;
    ArchetypeField field;
    TableInC<ArchetypeGrid> table{grid};
};

TEST_F(CTable, IsRefusedWithASentence) {
    EXPECT_EQ(refused([](auto&) {}), "");
    EXPECT_EQ(refused([](auto& t) { t.size = 40; }),
              "the table of the grid is too small: its size says 40 bytes");
    EXPECT_EQ(refused([](auto& t) { t.size = 0; }),
              "the table of the grid is too small: its size says 0 bytes");
    EXPECT_EQ(refused([](auto& t) { t.dimension = 1; }),
              "the table is of a grid of dimension 1, not 2 or 3");
    EXPECT_EQ(refused([](auto& t) { t.coarse_count = nullptr; }),
              "the table of the grid lacks the function 'coarse_count'");
    EXPECT_EQ(refused([](auto& t) { t.coarse = nullptr; }),
              "the table of the grid lacks the function 'coarse'");
    EXPECT_EQ(refused([](auto& t) { t.split = nullptr; }),
              "the table of the grid lacks the function 'split'");
    EXPECT_EQ(refused([](auto& t) { t.children = nullptr; }),
              "the table of the grid lacks the function 'children'");
    EXPECT_EQ(refused([](auto& t) { t.rules = nullptr; }), "the table of the grid lacks its rules");
    EXPECT_EQ(refused([](auto& t) { t.rule_count = -1; }), "the table of the grid lacks its rules");
}

TEST_F(CTable, WithAWrongRuleIsRefusedWithASentence) {
    // One good rule; every case spoils one number of it.
    struct Parts {
        nestgrid_stencil stencil{2, {0, 1}, {0.5, 0.5}, 0};
        std::array<nestgrid_child, 2> child{
            {{NESTGRID_TRIANGLE, {0, 3, 2}, 1}, {NESTGRID_TRIANGLE, {3, 1, 2}, 1}}};
        nestgrid_rule rule{"halves", NESTGRID_TRIANGLE, 1, nullptr, 2, nullptr};
    };
    const auto refused_with = [&](auto change) {
        Parts p;
        p.rule.new_nodes = &p.stencil;
        p.rule.children = p.child.data();
        change(p);
        return refused([&](auto& t) {
            t.rules = &p.rule;
            t.rule_count = 1;
        });
    };
    const std::string halves = "rule 'halves': ";
    EXPECT_EQ(refused_with([](auto&) {}), "");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.weight[1] = 0.75; }),
              halves + "new node 0 has weights that add up to 1.250000, not to 1");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.weight[1] = std::nan(""); }),
              halves + "new node 0 has a weight that is not positive");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.count = 9; }),
              halves + "a stencil has 9 parents, not 2 to 8");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.parent[0] = -1; }),
              halves + "a parent is no node");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.parent[0] = 3; }),
              halves + "new node 0 names a node that comes later");
    EXPECT_EQ(refused_with([](auto& p) { p.stencil.number = 256; }),
              halves + "a stencil has the number 256, not 0 to 255");
    EXPECT_EQ(refused_with([](auto& p) { p.child[0].corner[1] = 256; }),
              halves + "a corner of a child is no node");
    EXPECT_EQ(refused_with([](auto& p) { p.child[0].orientation = 257; }),
              halves + "a child has an orientation that is neither 1 nor -1");
    EXPECT_EQ(refused_with([](auto& p) { p.child[0].shape = 12; }),
              halves + "the shape 12 does not exist");
    EXPECT_EQ(refused_with([](auto& p) { p.rule.child_count = 1; }),
              halves + "volume lost: the children hold 0.500000 of their father");
    EXPECT_EQ(
        refused_with([](auto& p) { p.rule.child_count = 65; }),
        halves + "65 children, not 1 to 64; where it would need more, refine in several steps");
    EXPECT_EQ(
        refused_with([](auto& p) { p.rule.new_node_count = -1; }),
        halves + "-1 new nodes, not 0 to 64; where it would need more, refine in several steps");
    EXPECT_EQ(refused_with([](auto& p) { p.rule.children = nullptr; }),
              halves + "its tables are NULL");
    EXPECT_EQ(refused_with([](auto& p) {
                  p.rule.name = nullptr;
                  p.rule.shape = 0;
              }),
              "rule '': the shape 0 does not exist");
}

TEST_F(CTable, OfAFieldIsRefusedWithASentence) {
    const nestgrid_field good = field_in_c(grid, field);
    const auto refused_with = [&](auto change) {
        nestgrid_field t = good;
        change(t);
        return refusal<InvalidInput>([&] { open_table<float>(table.table, t); });
    };
    EXPECT_EQ(refused_with([](auto&) {}), "");
    EXPECT_EQ(refused_with([](auto& t) { t.size = 16; }),
              "the table of the field is too small: its size says 16 bytes");
    EXPECT_EQ(refused_with([](auto& t) { t.value_type = NESTGRID_DOUBLE; }),
              "the values of the field are of another type, float or double, than asked for");
    EXPECT_EQ(refused_with([](auto& t) { t.components = 0; }), "the field has 0 components");
    EXPECT_EQ(refused_with([](auto& t) { t.coarse_values = nullptr; }),
              "the table of the field lacks the function 'coarse_values' or 'new_values'");
    EXPECT_EQ(refused_with([](auto& t) { t.new_values = nullptr; }),
              "the table of the field lacks the function 'coarse_values' or 'new_values'");
}

TEST_F(CTable, OfAnOlderOrNewerLibraryIsUnderstood) {
    const auto lines = [&](const nestgrid_grid& t, const nestgrid_field& f) {
        return isosurface<2>(*open_table<float>(t, f), 3.0).surface;
    };
    const nestgrid_field good = field_in_c(grid, field);
    const auto expected = lines(table.table, good);
    EXPECT_EQ(expected.simplices.size(), 2U);

    // What lies beyond `size` is not read: here it is rubbish.
    nestgrid_grid old = table.table;
    old.size = offsetof(nestgrid_grid, corner_keys);
    std::memset(reinterpret_cast<char*>(&old) + old.size, 0x55, sizeof(old) - old.size);
    nestgrid_field old_field = good;
    old_field.size = offsetof(nestgrid_field, corner_gradients);
    std::memset(reinterpret_cast<char*>(&old_field) + old_field.size, 0x55,
                sizeof(old_field) - old_field.size);
    EXPECT_EQ(lines(old, old_field).simplices, expected.simplices);
    EXPECT_EQ(lines(old, old_field).vertices, expected.vertices);

    struct {
        nestgrid_grid known;
        void* unknown;
    } later{table.table, &later};
    later.known.size = sizeof(later);
    EXPECT_EQ(lines(later.known, good).vertices, expected.vertices);
}

TEST_F(CTable, WrongAnswersAreNamed) {
    const auto told = [&](auto change) {
        nestgrid_grid t = table.table;
        change(t);
        return refusal<GridError>(
            [&] { (void)isosurface<2>(*open_table<float>(t, field_in_c(grid, field)), 3.0); });
    };
    EXPECT_EQ(told([](auto& t) {
                  t.split = [](const void*, void*, const nestgrid_element*, int* rule) {
                      *rule = 3;
                      return 0;
                  };
              }),
              "split gave rule 3 of 1");
    EXPECT_EQ(told([](auto& t) {
                  t.coarse = [](const void*, void*, std::size_t, nestgrid_coarse* out) {
                      out->shape = 9;
                      return 0;
                  };
              }),
              "coarse element 0 has the shape 9, which does not exist");
    EXPECT_EQ(told([](auto& t) {
                  t.coarse = [](const void*, void*, std::size_t, nestgrid_coarse* out) {
                      out->shape = NESTGRID_TRIANGLE;  // and forgot the orientation
                      return 0;
                  };
              }),
              "coarse element 0 has an orientation that is neither 1 nor -1");
}

/// A function of the same type that fails.
template <class... Args>
auto failing(int (*)(Args...)) -> int (*)(Args...) {
    return [](Args...) { return 7; };
}

/// What drawing from tables says.
template <class Real>
std::string told(const nestgrid_grid& grid, const nestgrid_field& field, double isovalue) {
    return refusal<GridError>([&] {
        (void)isosurface<3>(*open_table<Real>(grid, field), isovalue, {},
                            {.normals = true, .cap = true});
    });
}
std::string with_code_7(const std::string& operation, const std::string& what) {
    return "the operation '" + operation + "' of the " + what + " failed with code 7";
}

TEST(Failures, NameTheOperation) {
    const LatticeBisection<3> lattice({.samples = {5, 6, 7}});
    std::vector<float> values(210, 0.0F);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 11);
    const LatticeField samples(lattice, std::span<const float>(values));
    const TableInC in_c(lattice);
    nestgrid_grid grid = in_c.table;
    nestgrid_field field = field_in_c(lattice, samples);
    grid.last_error = nullptr;
    field.last_error = nullptr;
    EXPECT_EQ(told<float>(grid, field, 5.5), "");

    const auto expect_named = [&](auto nestgrid_grid::*operation, const std::string& name) {
        nestgrid_grid t = grid;
        ASSERT_NE(t.*operation, nullptr) << name;
        t.*operation = failing(t.*operation);
        EXPECT_EQ(told<float>(t, field, 5.5), with_code_7(name, "grid"));
    };
    expect_named(&nestgrid_grid::coarse_count, "coarse_count");
    expect_named(&nestgrid_grid::coarse, "coarse");
    expect_named(&nestgrid_grid::split, "split");
    expect_named(&nestgrid_grid::children, "children");
    expect_named(&nestgrid_grid::corner_keys, "corner_keys");
    expect_named(&nestgrid_grid::new_keys, "new_keys");
    expect_named(&nestgrid_grid::corner_positions, "corner_positions");
    expect_named(&nestgrid_grid::masked, "masked");
    expect_named(&nestgrid_grid::outside, "outside");
    expect_named(&nestgrid_grid::boundary_faces, "boundary_faces");
    expect_named(&nestgrid_grid::epoch, "epoch");

    const auto expect_field_named = [&](auto nestgrid_field::*operation, const std::string& name) {
        nestgrid_field t = field;
        t.*operation = failing(t.*operation);
        EXPECT_EQ(told<float>(grid, t, 5.5), with_code_7(name, "field"));
    };
    expect_field_named(&nestgrid_field::coarse_values, "coarse_values");
    expect_field_named(&nestgrid_field::new_values, "new_values");
    expect_field_named(&nestgrid_field::corner_gradients, "corner_gradients");
}

TEST(Failures, NameTheOperationsOfCurvedGrids) {
    std::mt19937 random(4);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 100);
    const CurvedGrid curved(forest);
    const CurvedField distance(curved, [](const Point& x) { return norm(x); });
    const TableInC in_c(curved);
    const nestgrid_field field = field_in_c(curved, distance);
    nestgrid_grid grid = in_c.table;
    grid.last_error = nullptr;
    EXPECT_EQ(told<double>(grid, field, 0.7), "");
    nestgrid_grid t = grid;
    t.constrained = failing(t.constrained);
    EXPECT_EQ(told<double>(t, field, 0.7), with_code_7("constrained", "grid"));
    t = grid;
    t.new_positions = failing(t.new_positions);
    EXPECT_EQ(told<double>(t, field, 0.7), with_code_7("new_positions", "grid"));
    t = grid;
    t.make_context = [](const void*) -> void* { return nullptr; };
    EXPECT_EQ(told<double>(t, field, 0.7), "the operation 'make_context' of the grid failed");
    EXPECT_EQ(CurvedGrid::Context::live, 0);
}

TEST(Failures, AMissingValueIsToldAsByTheModel) {
    const Forest<3> forest = [] {
        Forest<3> f = kuhn<3>(0);
        for (std::uint32_t e = 0; e < 20; ++e) f.refine(e, red_tetrahedron_rule());
        return f;
    }();
    const MutantGrid<3> grid(forest);
    MutantField<3> field(grid, [](const Point& x) { return norm(x); });
    field.misses = 9;
    field.node = 4;
    const auto direct = refusal<GridError>([&] { (void)isosurface(grid, field, 0.7); });
    EXPECT_NE(direct.find("no value at new node 4 of an element on level 1"), std::string::npos)
        << direct;
    const TableInC in_c(grid);
    nestgrid_field table = field_in_c(grid, field);
    EXPECT_EQ(direct, told<double>(in_c.table, table, 0.7));

    table.coarse_values = [](const void*, void*, std::size_t, std::size_t, void*,
                             std::uint64_t* missing) {
        *missing = 4;
        return 0;
    };
    EXPECT_EQ(told<double>(in_c.table, table, 0.7),
              "the field has no value at corner 2 of coarse element 0");
}

/// A grid that fails on the way down, as a C++ code behind a C interface may.
struct Failing : Forest<3> {
    const Rule* split(std::uint32_t e) const {
        if (fails && e == 3) throw InvalidInput("cell 3 has left this process");
        return Forest<3>::split(e);
    }
    bool fails = false;
};

/// What a table says of its failures reaches who called the library, as text.
TEST(Failures, AreToldInTheWordsOfTheTable) {
    Failing grid{kuhn<3>(0)};
    const ForestField<3> field(grid, [](const Point& x) { return norm(x); });
    const TableInC in_c(grid);
    const nestgrid_field values = field_in_c(grid, field);
    EXPECT_EQ(told<double>(in_c.table, values, 0.7), "");
    grid.fails = true;
    EXPECT_EQ(told<double>(in_c.table, values, 0.7),
              "the operation 'split' of the grid failed: cell 3 has left this process");
    nestgrid_grid silent = in_c.table;
    silent.last_error = [](const void*, void*) -> const char* { return nullptr; };
    EXPECT_EQ(told<double>(silent, values, 0.7),
              "the operation 'split' of the grid failed with code 1");
    silent.last_error = [](const void*, void*) { return ""; };
    EXPECT_EQ(told<double>(silent, values, 0.7),
              "the operation 'split' of the grid failed with code 1");
    nestgrid_grid old = in_c.table;  // of a library without last_error
    old.size = offsetof(nestgrid_grid, last_error);
    EXPECT_EQ(told<double>(old, values, 0.7),
              "the operation 'split' of the grid failed with code 1");

    grid.fails = false;
    nestgrid_field full = values;
    full.coarse_values = failing(values.coarse_values);
    full.last_error = [](const void*, void*) { return "the disk is full"; };
    EXPECT_EQ(told<double>(in_c.table, full, 0.7),
              "the operation 'coarse_values' of the field failed: the disk is full");
}

}  // namespace
