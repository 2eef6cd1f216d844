// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Segments joined to lines: in any order, each segment once, rings closed.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/polylines.hpp>

using namespace nestgrid;

namespace polylines_test {

/// Segments along a line through some of the vertices.
void add_line(Surface<2>& to, std::initializer_list<std::uint32_t> vertices) {
    for (const auto* v = vertices.begin(); v + 1 != vertices.end(); ++v) {
        to.simplices.push_back({v[0], v[1]});
    }
}

TEST(Polylines, JoinsSegmentsInAnyOrder) {
    Surface<2> segments;
    for (int i = 0; i < 12; ++i) segments.vertices.push_back({1.0 * i, 1.0 * (i % 3), 0});
    segments.vertices[7] = segments.vertices[6];    // repeats its predecessor
    segments.vertices[11] = segments.vertices[10];  // a ring without length
    add_line(segments, {4, 0, 1});
    add_line(segments, {5, 6, 7, 8, 9, 5});
    add_line(segments, {3, 2});
    add_line(segments, {10, 11, 10});
    std::mt19937 random(1);
    for (int i = 0; i < 20; ++i) {
        std::shuffle(segments.simplices.begin(), segments.simplices.end(), random);
        const Polylines lines = polylines(segments, 0.25);
        ASSERT_EQ(lines.count(), 3U);
        const auto expect_line = [&](std::size_t number, std::vector<std::uint32_t> vertices) {
            std::vector<Point> expected, found;
            for (const auto v : vertices) expected.push_back(segments.vertices[v]);
            for (const auto v : lines.line(number)) found.push_back(lines.vertices[v]);
            EXPECT_EQ(found, expected);
            EXPECT_EQ(lines.closed(number), vertices.front() == vertices.back());
            EXPECT_EQ(lines.value[number], 0.25);
        };
        expect_line(0, {3, 2});
        expect_line(1, {4, 0, 1});
        expect_line(2, {5, 6, 8, 9, 5});
        EXPECT_EQ(lines.vertices.size(), 9U);
    }
}

/// Two rings that touch, and two lines that cross, in one vertex.
TEST(Polylines, UsesEachSegmentOnceWhereLinesTouch) {
    Surface<2> segments;
    for (int i = 0; i < 10; ++i) segments.vertices.push_back({1.0 * i, 0, 0});
    add_line(segments, {0, 1, 2, 0, 3, 4, 0});
    add_line(segments, {5, 6, 7});
    add_line(segments, {8, 6, 9});
    const Polylines lines = polylines(segments, 0);
    EXPECT_EQ(lines.count(), 4U);
    std::size_t open = 0;
    std::size_t joined = 0;
    for (std::size_t i = 0; i < lines.count(); ++i) {
        open += lines.closed(i) ? 0 : 1;
        joined += lines.line(i).size() - 1;
    }
    EXPECT_EQ(open, 2U);
    EXPECT_EQ(joined, segments.simplices.size());
    EXPECT_EQ(lines.vertices.size(), segments.vertices.size());
}

/// A line that meets its beginning again is a ring there, and the rest is a line of its own.
TEST(Polylines, BeginsLinesWhereTheyBranchOff) {
    Surface<2> segments;
    for (int i = 0; i < 6; ++i) segments.vertices.push_back({1.0 * i, 0, 0});
    add_line(segments, {4, 3, 5, 4, 0, 1, 2});
    const Polylines lines = polylines(segments, 0);
    ASSERT_EQ(lines.count(), 2U);
    EXPECT_TRUE(lines.closed(0));
    EXPECT_EQ(lines.line(0).size(), 4U);
    EXPECT_FALSE(lines.closed(1));
    EXPECT_EQ(lines.line(1).size(), 4U);
}

}  // namespace polylines_test
