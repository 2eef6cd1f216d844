// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Split sides of triangles: the same surface and function with more triangles, whichever sides they
// are.
#include <algorithm>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/detail/geometry.hpp>
#include <surfaces/split_sides.hpp>

using namespace nestgrid;
using engine::TriangleSide;

namespace split_sides_test {

/// Two triangles of a parallelogram, with 2x + 3y and 1 at their vertices.
Surface<3> two_triangles() {
    Surface<3> surface;
    surface.vertices = {{0, 0, 0}, {2, 0, 0}, {2.5, 1, 0}, {0.5, 1, 0}};
    surface.normals = {{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}};
    surface.attributes = {0, 1, 4, 1, 8, 1, 4, 1};
    surface.simplices = {{0, 1, 2}, {0, 2, 3}};
    surface.element_of = {7, 9};
    surface.boundary = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    return surface;
}

Point area(const Surface<3>& s, std::size_t t) {
    const auto& [a, b, c] = s.simplices[t];
    return 0.5 * cross(s.vertices[b] - s.vertices[a], s.vertices[c] - s.vertices[a]);
}

void expect_split(const std::vector<TriangleSide>& sides) {
    const Surface<3> before = two_triangles();
    Surface<3> s = before;
    const std::vector<bool> is_part = engine::split_sides(s, sides);
    const SurfaceReport report = surface_report(s);
    EXPECT_TRUE(report.manifold());
    EXPECT_EQ(report.open_edges, 0U);
    EXPECT_EQ(report.boundary_edges, s.boundary.size());
    EXPECT_NEAR(report.area, 2, 1e-15);

    ASSERT_EQ(s.vertices.size(), before.vertices.size() + sides.size());
    ASSERT_EQ(s.normals.size(), s.vertices.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const Point& a = before.vertices[sides[i].first()];
        const Point& b = before.vertices[sides[i].second()];
        EXPECT_EQ(s.vertices[4 + i], 0.5 * (a + b));
    }
    for (std::size_t v = 0; v < s.vertices.size(); ++v) {
        EXPECT_EQ(s.attributes[2 * v], 2 * s.vertices[v][0] + 3 * s.vertices[v][1]);
        EXPECT_EQ(s.attributes[2 * v + 1], 1);
        EXPECT_NEAR(norm(s.normals[v]), 1, 1e-15);
    }

    const bool in_both = std::ranges::count(sides, TriangleSide(0, 2)) > 0;
    EXPECT_EQ(s.simplices.size(), 2 + sides.size() + (in_both ? 1 : 0));
    ASSERT_EQ(s.element_of.size(), s.simplices.size());
    ASSERT_EQ(is_part.size(), s.simplices.size());
    EXPECT_TRUE(std::ranges::is_sorted(s.element_of));
    std::array<double, 2> sum{0, 0};
    for (std::size_t t = 0; t < s.simplices.size(); ++t) {
        const double part = area(s, t)[2];
        EXPECT_GT(part, 0);
        EXPECT_EQ(is_part[t], part < 1);
        sum[s.element_of[t] == 7 ? 0 : 1] += part;
    }
    EXPECT_EQ(sum[0], 1);
    EXPECT_EQ(sum[1], 1);
}

TEST(SplitSides, LeaveTheSameSurface) {
    const std::array<TriangleSide, 5> all{{{0, 1}, {2, 0}, {0, 3}, {2, 1}, {3, 2}}};
    ASSERT_TRUE(std::ranges::is_sorted(all));
    for (unsigned subset = 0; subset < 32; ++subset) {
        std::vector<TriangleSide> sides;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if ((subset >> i & 1U) != 0) sides.push_back(all[i]);
        }
        SCOPED_TRACE(subset);
        expect_split(sides);
    }
}

}  // namespace split_sides_test
