// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The algorithms that C codes call give what the C++ ones give, and failures are sentences.
#include <cstring>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/adapters/bisection.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

#include "curved.hpp"
#include "sample_fields.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace c_isosurface_test {

template <class Grid, class Field>
void expect_same(const Grid& grid, const Field& field, double isovalue, double threshold) {
    const TableInC in_c(grid);
    const nestgrid_grid& t = in_c.table;
    const nestgrid_field f = field_in_c(grid, field);
    nestgrid_surface surface;
    std::array<char, 100> message{};
    ASSERT_EQ(nestgrid_isosurface(&t, &f, isovalue, threshold, &surface, message.data(), 100), 0)
        << message.data();
    const auto direct = isosurface(grid, field, isovalue, {.threshold = threshold});
    ASSERT_EQ(surface.vertex_count, direct.surface.vertices.size());
    ASSERT_EQ(surface.simplex_count, direct.surface.simplices.size());
    EXPECT_GT(surface.simplex_count, 0U);
    EXPECT_EQ(surface.dimension, Grid::dimension);
    EXPECT_EQ(surface.error_bound, direct.error_bound);
    EXPECT_EQ(surface.range_bound, direct.range_bound);
    EXPECT_EQ(surface.bound_says_nothing != 0, direct.bound_says_nothing());
    // Where everything is drawn, tables find it by the ranges of splits, not by offsets.
    EXPECT_LE(surface.visited, direct.counts.visited);
    EXPECT_TRUE(threshold == 0 || surface.visited == direct.counts.visited);
    EXPECT_EQ(surface.extracted, direct.counts.extracted);
    for (std::size_t v = 0; v < surface.vertex_count; ++v) {
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_EQ(surface.vertices[3 * v + d], direct.surface.vertices[v][d]);
        }
    }
    for (std::size_t s = 0; s < surface.simplex_count; ++s) {
        for (std::size_t k = 0; k < Grid::dimension; ++k) {
            EXPECT_EQ(surface.simplices[Grid::dimension * s + k], direct.surface.simplices[s][k]);
        }
    }
    nestgrid_surface_free(&surface);
    EXPECT_EQ(surface.vertices, nullptr);
    EXPECT_EQ(surface.vertex_count, 0U);
    nestgrid_surface_free(&surface);  // nothing left to free
}

TEST(IsosurfaceForC, IsTheSame) {
    const Samples n{13, 18, 21};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[1];
    const LatticeField field(grid, std::span<const float>(data.values));
    for (const double threshold : {0.0, 0.1}) expect_same(grid, field, data.isovalue, threshold);

    const LatticeBisection<2> image({.samples = {17, 12}});
    std::vector<double> values;
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 17; ++x) values.push_back(std::hypot(x - 8.0, y - 6.0));
    }
    const LatticeField distance(image, std::span<const double>(values));
    expect_same(image, distance, 4.5, 0.1);
}

TEST(IsosurfaceForC, IsCutWhereTheFinestDataAre) {
    const Samples n{13, 18, 21};
    const LatticeBisection<3> grid({.samples = n});
    const SampledField data = sampled_fields(n)[1];
    const LatticeField field(grid, std::span<const float>(data.values));
    const TableInC in_c(grid);
    const nestgrid_field f = field_in_c(grid, field);
    nestgrid_options options{};
    options.size = sizeof(options);
    options.threshold = 0.1;
    options.finest_cuts = 1;
    nestgrid_surface surface;
    std::array<char, 100> message{};
    ASSERT_EQ(nestgrid_isosurface_with(&in_c.table, &f, data.isovalue, &options, &surface,
                                       message.data(), 100),
              0)
        << message.data();
    const auto direct =
        isosurface(grid, field, data.isovalue, {.threshold = 0.1}, {.cuts = Cuts::finest});
    ASSERT_EQ(surface.vertex_count, direct.surface.vertices.size());
    for (std::size_t v = 0; v < surface.vertex_count; ++v) {
        for (std::size_t d = 0; d < 3; ++d) {
            ASSERT_EQ(surface.vertices[3 * v + d], direct.surface.vertices[v][d]);
        }
    }
    nestgrid_surface_free(&surface);
}

class FailuresForC : public ::testing::Test {
protected:
    std::string isosurface_says(double isovalue = 0.5, double threshold = 0) {
        message.fill('x');
        nestgrid_surface surface;
        code = nestgrid_isosurface(&t, &f, isovalue, threshold, &surface, message.data(),
                                   message.size());
        const bool empty = surface.vertices == nullptr && surface.owner == nullptr;
        EXPECT_EQ(code != 0, empty);
        nestgrid_surface_free(&surface);
        return code == 0 ? "" : message.data();
    }
    std::string check_says() {
        message.fill('x');
        code = nestgrid_check_grid(&t, &f, message.data(), message.size());
        return code == 0 ? "" : message.data();
    }

    Forest<3> forest = [] {
        Forest<3> result = kuhn<3>(0);
        for (std::uint32_t e = 0; e < 10; ++e) result.refine(e, red_tetrahedron_rule());
        return result;
    }();
    MutantGrid<3> grid{forest};
    MutantField<3> field{grid, [](const Point& x) { return norm(x); }};
    TableInC<MutantGrid<3>> in_c{grid};
    nestgrid_grid t = in_c.table;
    nestgrid_field f = field_in_c(grid, field);
    std::array<char, 200> message{};
    int code = 0;
};

TEST_F(FailuresForC, AreSentences) {
    EXPECT_EQ(isosurface_says(), "");
    EXPECT_EQ(isosurface_says(std::nan("")), "the isovalue is not a finite number");
    EXPECT_EQ(code, 1);
    EXPECT_EQ(isosurface_says(0.5, -1), "the threshold is negative or not a number");
    t.dimension = 4;
    EXPECT_EQ(isosurface_says(), "the table is of a grid of dimension 4, not 2 or 3");
    t.dimension = 2;
    EXPECT_EQ(isosurface_says(), "coarse element 0 is a tetrahedron, but the grid has dimension 2");
    EXPECT_EQ(code, 2);
    t.dimension = 3;
    f.value_type = 5;
    EXPECT_EQ(isosurface_says(), "the value_type 5 of the field is neither float nor double");
    f.value_type = NESTGRID_DOUBLE;
    f.components = 3;
    EXPECT_EQ(isosurface_says(), "the field has 3 components, not 1");
    f.components = 1;
    EXPECT_EQ(isosurface_says(), "");
}

TEST_F(FailuresForC, OfNullTablesAreSentences) {
    nestgrid_surface surface;
    EXPECT_EQ(nestgrid_isosurface(nullptr, &f, 0.5, 0, &surface, message.data(), 200), 1);
    EXPECT_STREQ(message.data(), "a table is NULL");
    EXPECT_EQ(nestgrid_check_grid(&t, nullptr, message.data(), 200), 1);
    EXPECT_STREQ(message.data(), "a table is NULL");
}

TEST_F(FailuresForC, FitIntoTheRoomThereIs) {
    nestgrid_surface surface;
    message.fill('x');
    EXPECT_EQ(nestgrid_isosurface(nullptr, &f, 0.5, 0, &surface, message.data(), 8), 1);
    EXPECT_STREQ(message.data(), "a table");
    EXPECT_EQ(message[8], 'x');
    message.fill('x');
    EXPECT_EQ(nestgrid_isosurface(nullptr, &f, 0.5, 0, &surface, message.data(), 0), 1);
    EXPECT_EQ(message[0], 'x');
    EXPECT_EQ(nestgrid_isosurface(nullptr, &f, 0.5, 0, &surface, nullptr, 200), 1);
}

TEST_F(FailuresForC, OfAModelAreSentences) {
    field.misses = 2;
    EXPECT_EQ(isosurface_says(),
              "the field has no value at new node 0 of an element on level 0 below coarse element "
              "2");
    EXPECT_EQ(check_says(), "the field lacks a value at a new node of element 2");
    EXPECT_EQ(code, 4);
    field.misses = MutantGrid<3>::nowhere;
    EXPECT_EQ(check_says(), "");
}

TEST_F(FailuresForC, AreToldInTheWordsOfTheTable) {
    t.children = [](const void*, void*, const nestgrid_element*, std::size_t, nestgrid_element*) {
        last_sentence() = "cell 3 has left this process";
        return 9;
    };
    const std::string sentence =
        "the operation 'children' of the grid failed: cell 3 has left this process";
    EXPECT_EQ(isosurface_says(), sentence);
    EXPECT_EQ(code, 2);
    EXPECT_EQ(check_says(), sentence);
    EXPECT_EQ(code, 2);
}

}  // namespace c_isosurface_test
