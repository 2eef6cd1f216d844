// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isolines of C codes have the bits that C++ codes get.
#include <nestgrid/algorithms/isolines.h>
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/surface_isolines.hpp>

#include "c_scenes.hpp"

namespace c_algorithms_test {

void expect_same_lines(nestgrid_lines& lines, const Polylines& direct) {
    ASSERT_GT(lines.line_count, 0U);
    ASSERT_EQ(lines.vertex_count, direct.vertices.size());
    expect_points(lines.vertices, direct.vertices);
    ASSERT_EQ(lines.attribute_count, direct.attribute_count);
    for (std::size_t i = 0; i < direct.attributes.size(); ++i) {
        ASSERT_EQ(lines.attributes[i], direct.attributes[i]);
    }
    ASSERT_EQ(lines.line_count, direct.count());
    for (std::size_t i = 0; i < lines.line_count; ++i) {
        ASSERT_EQ(lines.values[i], direct.value[i]);
        ASSERT_EQ(lines.first[i + 1], direct.first[i + 1]);
    }
    for (std::size_t i = 0; i < direct.points.size(); ++i) {
        ASSERT_EQ(lines.points[i], direct.points[i]);
    }
    nestgrid_lines_free(&lines);
    EXPECT_EQ(lines.points, nullptr);
    EXPECT_EQ(lines.size, sizeof(lines));
}

TEST(IsolinesForC, AreTheSame) {
    const std::array<double, 3> values{-0.1, 0.2, 0.5};
    for (const auto& forest : forests<2>()) {
        Scene<2> scene(forest);
        scene.ask_for_attribute();
        scene.options.threshold = 0.02;
        nestgrid_lines lines{};
        lines.size = sizeof(lines);
        ASSERT_EQ(nestgrid_isolines(&scene.in_c.table, &scene.field, values.data(), 3,
                                    &scene.options, &lines, scene.message.data(), 200),
                  0)
            << scene.message.data();
        const Isolines direct = isolines(scene.grid, scene.both, values, {.threshold = 0.02});
        EXPECT_EQ(lines.error_bound, direct.error_bound);
        EXPECT_EQ(lines.extracted, direct.counts.extracted);
        expect_same_lines(lines, direct.lines);
    }
}

TEST(IsolinesForC, AreTheSameOnSlices) {
    Scene<3> scene(forests<3>()[0]);
    const std::array<double, 2> values{0.1, 0.4};
    const Point through{0.5, 0.5, 0.5};
    const Point normal{0, 0, 1};
    nestgrid_surface surface;
    ASSERT_EQ(nestgrid_slice(&scene.in_c.table, &scene.field, through.data(), normal.data(),
                             nullptr, &surface, nullptr, 0),
              0);
    nestgrid_lines lines{};
    lines.size = sizeof(lines);
    ASSERT_EQ(nestgrid_surface_isolines(&surface, 0, values.data(), 2, &lines, nullptr, 0), 0);
    const Slice direct = slice(scene.grid, scene.first, Plane(through, normal));
    expect_same_lines(lines, isolines(direct.surface, 0, values));
    nestgrid_surface_free(&surface);
}

}  // namespace c_algorithms_test
