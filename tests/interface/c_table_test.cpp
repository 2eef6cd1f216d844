// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables that are wrong, operations that fail, and what crosses a table.
#include <cstddef>

#include <gtest/gtest.h>

#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/any_grid.hpp>

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
        return refusal<InvalidInput>([&] { AnyGrid<2>{t}; });
    }
    ArchetypeGrid grid;
    ArchetypeField field;
    TableInC<ArchetypeGrid> table{grid, {&bisection_rule(Shape::triangle, 2)}};
};

TEST_F(CTable, IsRefusedWithASentence) {
    EXPECT_EQ(refused([](auto&) {}), "");
    EXPECT_EQ(refused([](auto& t) { t.size = 40; }),
              "the table of the grid is too small: its size says 40 bytes");
    EXPECT_EQ(refused([](auto& t) { t.size = 0; }),
              "the table of the grid is too small: its size says 0 bytes");
    EXPECT_EQ(refused([](auto& t) { t.dimension = 3; }),
              "the table is of a grid of dimension 3, not 2");
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
    EXPECT_EQ(refused_with([](auto& p) { p.rule.child_count = 65; }),
              halves + "65 children, not 1 to 64");
    EXPECT_EQ(refused_with([](auto& p) { p.rule.new_node_count = -1; }),
              halves + "-1 new nodes, not 0 to 64");
    EXPECT_EQ(refused_with([](auto& p) { p.rule.children = nullptr; }),
              halves + "its tables are NULL");
    EXPECT_EQ(refused_with([](auto& p) {
                  p.rule.name = nullptr;
                  p.rule.shape = 0;
              }),
              "rule '': the shape 0 does not exist");
}

TEST_F(CTable, OfAFieldIsRefusedWithASentence) {
    const nestgrid_field good = make_table(grid, field);
    const auto refused_with = [&](auto change) {
        nestgrid_field t = good;
        change(t);
        return refusal<InvalidInput>([&] { AnyField<float>{t}; });
    };
    EXPECT_EQ(refused_with([](auto&) {}), "");
    EXPECT_EQ(refused_with([](auto& t) { t.size = 16; }),
              "the table of the field is too small: its size says 16 bytes");
    EXPECT_EQ(refused_with([](auto& t) { t.value_type = NESTGRID_DOUBLE; }),
              "the values of the field are of another type, float or double, than asked for");
    EXPECT_EQ(refused_with([](auto& t) { t.components = 2; }), "the field has 2 components, not 1");
    EXPECT_EQ(refused_with([](auto& t) { t.coarse_values = nullptr; }),
              "the table of the field lacks the function 'coarse_values' or 'new_values'");
    EXPECT_EQ(refused_with([](auto& t) { t.new_values = nullptr; }),
              "the table of the field lacks the function 'coarse_values' or 'new_values'");
    EXPECT_EQ(refusal<InvalidInput>([&] { AnyField<float, 3>{good}; }),
              "the field has 1 components, not 3");
}

TEST_F(CTable, OfAnOlderOrNewerLibraryIsUnderstood) {
    const auto lines = [&](const nestgrid_grid& t, const nestgrid_field& f) {
        return isosurface(AnyGrid<2>(t), AnyField<float>(f), 3.0).surface;
    };
    const nestgrid_field good = make_table(grid, field);
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
            [&] { (void)isosurface(AnyGrid<2>(t), AnyField<float>(grid, field), 3.0); });
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

TEST(Failures, NameTheOperation) {
    const auto told = [](const nestgrid_grid& t, const auto& f, double isovalue) {
        return refusal<GridError>([&] {
            const AnyGrid<3> grid(t);
            (void)isosurface(grid, f, isovalue, {.normals = true, .cap = true});
        });
    };
    const LatticeBisection<3> lattice({.samples = {5, 6, 7}});
    std::vector<float> values(210, 0.0F);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 11);
    const LatticeField samples(lattice, std::span<const float>(values));
    const nestgrid_grid grid = make_table(lattice);
    const nestgrid_field field = make_table(lattice, samples);
    EXPECT_EQ(told(grid, AnyField<float>(field), 5.5), "");

    const auto sentence = [](const std::string& operation, const std::string& what) {
        return "the operation '" + operation + "' of the " + what + " failed with code 7";
    };
    const auto expect_named = [&](auto nestgrid_grid::*operation, const std::string& name) {
        nestgrid_grid t = grid;
        ASSERT_NE(t.*operation, nullptr) << name;
        t.*operation = failing(t.*operation);
        EXPECT_EQ(told(t, AnyField<float>(field), 5.5), sentence(name, "grid"));
    };
    expect_named(&nestgrid_grid::coarse_count, "coarse_count");
    expect_named(&nestgrid_grid::coarse, "coarse");
    expect_named(&nestgrid_grid::library_split, "split");
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
        EXPECT_EQ(told(grid, AnyField<float>(t), 5.5), sentence(name, "field"));
    };
    expect_field_named(&nestgrid_field::coarse_values, "coarse_values");
    expect_field_named(&nestgrid_field::new_values, "new_values");
    expect_field_named(&nestgrid_field::corner_gradients, "corner_gradients");

    std::mt19937 random(4);
    Forest<3> forest = kuhn<3>(3);
    refine_randomly(forest, random, 100);
    const CurvedGrid curved(forest);
    const CurvedField distance(curved, [](const Point& x) { return norm(x); });
    nestgrid_grid t = make_table(curved);
    EXPECT_EQ(told(t, AnyField<double>(curved, distance), 0.7), "");
    t.constrained = failing(t.constrained);
    EXPECT_EQ(told(t, AnyField<double>(curved, distance), 0.7), sentence("constrained", "grid"));
    t = make_table(curved);
    t.new_positions = failing(t.new_positions);
    EXPECT_EQ(told(t, AnyField<double>(curved, distance), 0.7), sentence("new_positions", "grid"));
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
    EXPECT_EQ(direct, refusal<GridError>([&] {
                  (void)isosurface(AnyGrid<3>(grid), AnyField<double>(grid, field), 0.7);
              }));

    nestgrid_field table = make_table(grid, field);
    table.coarse_values = [](const void*, void*, std::size_t, std::size_t, void*,
                             std::uint64_t* missing) {
        *missing = 4;
        return 0;
    };
    EXPECT_EQ(refusal<GridError>(
                  [&] { (void)isosurface(AnyGrid<3>(grid), AnyField<double>(table), 0.7); }),
              "the field has no value at corner 2 of coarse element 0");
}

/// Throws wherever it can.
template <class Error>
struct Throwing {
    using Element = int;
    struct Context {
        explicit Context(const Throwing&) { fail(); }
    };
    using value_type = double;
    static constexpr int dimension = 3;

    [[noreturn]] static void fail() { throw Error("no"); }
    Context make_context() const { return Context(*this); }
    std::size_t coarse_count() const { fail(); }
    CoarseElement<int> coarse(std::size_t) const { fail(); }
    const Rule* split(int) const { fail(); }
    void children(int, std::span<int>) const { fail(); }
    void corner_keys(int, std::span<NodeKey>) const { fail(); }
    void new_keys(int, std::span<NodeKey>) const { fail(); }
    void corner_positions(int, std::span<Point>) const { fail(); }
    void new_positions(int, NodeMask, std::span<Point>) const { fail(); }
    NodeMask constrained(int) const { fail(); }
    bool masked(int) const { fail(); }
    Hidden hidden(int) const { fail(); }
    NodeMask outside(int) const { fail(); }
    unsigned boundary_faces(int) const { fail(); }
    std::uint64_t epoch() const { fail(); }
    NodeMask coarse_values(std::size_t, std::span<double>) const { fail(); }
    NodeMask new_values(int, NodeMask, std::span<double>) const { fail(); }
    void corner_gradients(int, std::span<Point>) const { fail(); }
};

template <class Error>
void expect_codes(int code) {
    const Throwing<Error> model;
    const nestgrid_grid t = make_table(model);
    const nestgrid_field f = make_table(model, model);
    EXPECT_EQ(t.make_context(t.self), nullptr);
    alignas(typename Throwing<Error>::Context) std::array<std::byte, 8> any{};  // nobody looks
    void* c = any.data();
    const nestgrid_element e{};
    std::array<nestgrid_element, 8> children{};
    std::array<std::uint64_t, 8> bits{};
    std::array<double[3], 8> rows{};  // NOLINT(modernize-avoid-c-arrays)
    nestgrid_coarse coarse{};
    std::size_t count = 0;
    const void* rule = nullptr;
    int answer = 0;
    unsigned faces = 0;
    EXPECT_EQ(t.coarse_count(t.self, &count), code);
    EXPECT_EQ(t.coarse(t.self, c, 0, &coarse), code);
    EXPECT_EQ(t.library_split(t.self, c, &e, &rule), code);
    EXPECT_EQ(t.children(t.self, c, &e, 8, children.data()), code);
    EXPECT_EQ(t.corner_keys(t.self, c, &e, 4, bits.data()), code);
    EXPECT_EQ(t.new_keys(t.self, c, &e, 6, bits.data()), code);
    EXPECT_EQ(t.corner_positions(t.self, c, &e, 4, rows.data()), code);
    EXPECT_EQ(t.new_positions(t.self, c, &e, 1, 6, rows.data()), code);
    EXPECT_EQ(t.constrained(t.self, c, &e, bits.data()), code);
    EXPECT_EQ(t.masked(t.self, c, &e, &answer), code);
    EXPECT_EQ(t.hidden(t.self, c, &e, &answer), code);
    EXPECT_EQ(t.outside(t.self, c, &e, bits.data()), code);
    EXPECT_EQ(t.boundary_faces(t.self, c, &e, &faces), code);
    EXPECT_EQ(t.epoch(t.self, bits.data()), code);
    EXPECT_EQ(f.coarse_values(f.self, c, 0, 4, rows.data(), bits.data()), code);
    EXPECT_EQ(f.new_values(f.self, c, &e, 1, 6, rows.data(), bits.data()), code);
    EXPECT_EQ(f.corner_gradients(f.self, c, &e, 4, rows.data()), code);
    // A task whose context could not be made is told so by every operation.
    EXPECT_EQ(t.coarse(t.self, nullptr, 0, &coarse), 2);
    EXPECT_EQ(f.new_values(f.self, nullptr, &e, 1, 6, rows.data(), bits.data()), 2);
}

TEST(Failures, NothingIsThrownThroughATable) {
    expect_codes<InvalidInput>(1);
    expect_codes<GridError>(2);
    expect_codes<std::runtime_error>(3);
}

}  // namespace
