// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Slices and height fields of C codes have the bits that C++ codes get.
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/slice.hpp>

#include "c_scenes.hpp"

namespace c_algorithms_test {

TEST(HeightFieldsForC, AreTheSame) {
    for (const auto& forest : forests<2>()) {
        Scene<2> scene(forest);
        scene.ask_for_attribute();
        scene.options.threshold = 0.05;
        scene.options.elements = 1;
        const auto height = [&] {
            nestgrid_surface surface;
            EXPECT_EQ(nestgrid_height_field(&scene.in_c.table, &scene.field, 0.5, &scene.options,
                                            &surface, scene.message.data(), 200),
                      0)
                << scene.message.data();
            return surface;
        };
        nestgrid_surface surface = height();
        expect_same(surface, height_field(scene.grid, scene.both, 0.5, {.threshold = 0.05}));
        scene.options.threshold = 0;
        scene.options.max_triangles = 40;
        surface = height();
        EXPECT_LE(surface.simplex_count, 40U);
        EXPECT_GT(surface.simplex_count, 0U);
        nestgrid_surface_free(&surface);
    }
}

class SlicesForC : public ::testing::Test {
protected:
    static constexpr Point through{0.4, 0.5, 0.3};
    static constexpr Point normal{1, 0.5, -2};

    static int ball(const void* radius, const double* x, double* out) {
        *out = std::hypot(x[0], x[1], x[2]) - *static_cast<const double*>(radius);
        return 0;
    }
    static int ball_variation(const void*, const double*, double radius, double* out) {
        *out = radius;
        return 0;
    }
};

TEST_F(SlicesForC, AreTheSameAlongPlanes) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        scene.ask_for_attribute();
        scene.options.elements = 1;
        const Plane plane(through, normal);
        const auto cut = [&] {
            nestgrid_surface surface;
            EXPECT_EQ(nestgrid_slice(&scene.in_c.table, &scene.field, through.data(), normal.data(),
                                     &scene.options, &surface, scene.message.data(), 200),
                      0)
                << scene.message.data();
            return surface;
        };
        for (const double threshold : {0.0, 0.1}) {
            scene.options.threshold = threshold;
            nestgrid_surface surface = cut();
            expect_same(surface, slice(scene.grid, scene.both, plane, {.threshold = threshold}));
        }
        scene.options.threshold = 0;
        scene.options.max_triangles = 30;
        nestgrid_surface surface = cut();
        expect_same(surface, slice(scene.grid, scene.both, plane, {.max_triangles = 30}));

        scene.options.max_triangles = 0;
        scene.options.error = 0.1;
        const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
        surface = cut();
        expect_same(surface, slice(scene.grid, scene.both, plane, under(deviations, 0.1)));
    }
}

TEST_F(SlicesForC, HaveTheBoundaryOfTheDomain) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        for (const double threshold : {0.0, 0.1}) {
            scene.options.threshold = threshold;
            nestgrid_surface surface{};
            ASSERT_EQ(nestgrid_boundary_surface(&scene.in_c.table, &scene.field, &scene.options,
                                                &surface, scene.message.data(), 200),
                      0)
                << scene.message.data();
            expect_same(surface, boundary_surface(scene.grid, scene.first, {.threshold = threshold},
                                                  {.elements = false}));
        }
    }
}

TEST_F(SlicesForC, AreTheSameAlongFunctions) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        const double radius = 0.8;
        nestgrid_level_function function{};
        function.size = sizeof(function);
        function.self = &radius;
        function.value = ball;
        for (const bool bounded : {false, true}) {
            function.variation = bounded ? ball_variation : nullptr;
            nestgrid_surface surface;
            ASSERT_EQ(nestgrid_slice_along(&scene.in_c.table, &scene.field, &function, nullptr,
                                           &surface, scene.message.data(), 200),
                      0)
                << scene.message.data();
            const Sphere sphere({0, 0, 0}, radius);
            const auto direct = slice(scene.grid, scene.first, sphere, {}, {.elements = false});
            ASSERT_GT(direct.surface.simplices.size(), 0U);
            EXPECT_EQ(surface.simplex_count, direct.surface.simplices.size());
            EXPECT_EQ(surface.visited == direct.counts.visited, bounded);
            nestgrid_surface_free(&surface);
        }
    }
}

}  // namespace c_algorithms_test
