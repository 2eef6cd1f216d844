// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces of C codes have, by their options, the bits that C++ codes get.
#include <atomic>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/isoband.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include <threads/thread_executor.hpp>

#include "c_scenes.hpp"
#include "executor_laws.hpp"

namespace c_algorithms_test {

TEST(IsosurfacesForC, KeepWhatOptionsAskFor) {
    for_each_scene([](auto& scene) {
        scene.ask_for_attribute();
        scene.options.threshold = 0.05;
        scene.options.normals = scene.options.elements = scene.options.reference = 1;
        scene.options.cap = 1;
        scene.options.threads = 1;
        const auto direct = isosurface(scene.grid, scene.both, isovalue, {.threshold = 0.05},
                                       {.normals = true, .cap = true, .reference = true});
        EXPECT_GT(direct.surface.attributes.size(), 0U);
        for (const int threads : {0, 1, 3, NESTGRID_ALL_THREADS}) {
            scene.options.threads = threads;
            nestgrid_surface surface = draw(scene);
            expect_same(surface, direct);
        }
    });
}

TEST(IsosurfacesForC, HaveVerticesAtNodes) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        scene.options.at_nodes = 1;
        for (double& v : scene.first.values) v = std::round(5 * v) / 5;  // often the isovalue
        nestgrid_surface surface = draw(scene);
        Prerolls prerolls(FieldOnGrid(scene.grid, scene.first));
        expect_same(surface,
                    isosurface<3>(prerolls, isovalue, {}, {.elements = false, .at_nodes = true}));
    }
}

TEST(IsosurfacesForC, HaveEveryIndicator) {
    for_each_scene([](auto& scene) {
        const double level = isovalue;
        const auto levels = std::span(&level, 1);
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
        const auto expect = [&](int indicator, const auto& eta, const Bounds& bounds) {
            scene.options.indicator = indicator;
            scene.options.threshold = 0.1;
            nestgrid_surface surface = draw(scene);
            expect_same(surface, draw_directly(scene, Threshold(&eta, 0.1), bounds));
        };
        expect(NESTGRID_OFFSET, offsets, offsets);
        expect(NESTGRID_DEVIATION, deviations, deviations);
        expect(NESTGRID_NUMERICAL, numerical_indicator({scene.grid, scene.first}), offsets);
        expect(NESTGRID_WAVELET, wavelet_indicator({scene.grid, scene.first}), offsets);
        expect(NESTGRID_VISUAL, visual_indicator({scene.grid, scene.first}), offsets);
        expect(NESTGRID_NORM, norm_indicator({scene.grid, scene.first}), offsets);
        expect(NESTGRID_CUT, cut_deviations({scene.grid, scene.first}, levels, offsets), offsets);
        expect(NESTGRID_SLOPE, slope_deviations({scene.grid, scene.first}, levels, offsets),
               offsets);
    });
}

TEST(IsosurfacesForC, KeepAnError) {
    for_each_scene([](auto& scene) {
        scene.options.error = 0.1;
        const double level = isovalue;
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
        const auto cuts = cut_deviations({scene.grid, scene.first}, std::span(&level, 1), offsets);
        const bool simplices = scene.grid.cells[0].shape == Shape::triangle ||
                               scene.grid.cells[0].shape == Shape::tetrahedron;
        const auto direct = simplices
                                ? draw_directly(scene, Threshold(&cuts, 0.1), offsets)
                                : draw_directly(scene, Threshold(&deviations, 0.1), deviations);
        for (const int threads : {1, 3}) {
            scene.options.threads = threads;
            nestgrid_surface surface = draw(scene);
            nestgrid_surface_details d{};
            d.size = sizeof(d);
            ASSERT_EQ(nestgrid_details(&surface, &d, nullptr, 0), 0);
            EXPECT_EQ(d.threshold, 0.1);
            EXPECT_EQ(d.surface_error, direct.surface_error);
            EXPECT_EQ(d.surface_error <= 0.1, simplices);
            expect_same(surface, direct);
        }
    });
}

TEST(IsosurfacesForC, KeepWithinABudget) {
    for_each_scene([](auto& scene) {
        scene.options.max_triangles = 60;
        nestgrid_surface surface = draw(scene);
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        const auto search =
            isosurface(scene.grid, scene.first, isovalue, under(offsets, {.max_triangles = 60}))
                .search;
        nestgrid_surface_details d{};
        d.size = sizeof(d);
        ASSERT_EQ(nestgrid_details(&surface, &d, nullptr, 0), 0);
        EXPECT_EQ(d.threshold, search.threshold);
        EXPECT_EQ(d.budget_text, search.reason());
        EXPECT_LE(surface.simplex_count, 60U);
        expect_same(surface, isosurface(scene.grid, scene.first, isovalue, {.max_triangles = 60},
                                        {.elements = false}));
    });
}

/// What a projection says beside its threshold.
TEST(IsosurfacesForC, AreDrawnUnderEveryProjection) {
    const auto distance = [](void*, const double* x, double* out) {
        *out = Ball{{0.3, 0.3, 0.3}, 0.2}({x[0], x[1], x[2]});
        return 0;
    };
    const nestgrid_lens in_c{sizeof(nestgrid_lens), nullptr, distance, 0.1, 0, 0.25};
    const LensRequest lens{.distance = Ball{{0.3, 0.3, 0.3}, 0.2}, .finest = 0.1, .slope = 0.25};
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        Prerolls prerolls(FieldOnGrid(scene.grid, scene.first));
        const auto expect = [&](const Projection& projection) {
            nestgrid_surface surface = draw(scene);
            expect_same(surface,
                        isosurface<3>(prerolls, isovalue, projection, {.elements = false}));
            scene.options = {};
            scene.options.size = sizeof(scene.options);
        };
        scene.options.threshold = 0.1;
        scene.options.blend = 2;
        expect({.threshold = 0.1, .blend = 2});
        scene.options.threshold = 0.1;
        scene.options.collapse = 1;
        scene.options.indicator = NESTGRID_DEVIATION;
        expect({.threshold = 0.1, .indicator = "deviation", .collapse = true});
        scene.options.threshold = 0.1;
        scene.options.indicator = NESTGRID_SLOPE;
        scene.options.keep_distance = 1;
        expect({.threshold = 0.1, .indicator = "slope", .keeps_distance = true});
        scene.options.lens = &in_c;
        expect({.lens = lens});
        scene.options.threshold = 0.1;
        scene.options.lens = &in_c;
        expect({.threshold = 0.1, .lens = lens});
        const nestgrid_region region{sizeof(region), nullptr, distance, 0.01};
        scene.options.threshold = 0.4;
        scene.options.region = &region;
        expect({.threshold = 0.4, .region = RegionRequest{lens.distance, 0.01}});
    }
}

TEST(MeasuresForC, AreThoseOfTheLibrary) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        scene.options.threshold = 0.2;
        nestgrid_surface surface{};
        ASSERT_EQ(nestgrid_isosurface_with(&scene.in_c.table, &scene.field, isovalue,
                                           &scene.options, &surface, nullptr, 0),
                  0);
        nestgrid_measured measured{};
        measured.size = sizeof(measured);
        ASSERT_EQ(nestgrid_measure(&scene.in_c.table, &scene.field, &surface, isovalue, 500,
                                   &scene.options, &measured, nullptr, 0),
                  0);
        nestgrid_surface_free(&surface);
        Prerolls prerolls(FieldOnGrid(scene.grid, scene.first));
        const MeasuredError direct = measure_error(
            prerolls, isosurface<3>(prerolls, isovalue, {.threshold = 0.2}).surface, isovalue, 500);
        EXPECT_EQ(measured.value.greatest, direct.value.greatest);
        EXPECT_EQ(measured.distance.mean, direct.distance.mean);
        EXPECT_EQ(measured.back.rms, direct.back.rms);
        EXPECT_EQ(measured.points, direct.points);
    }
}

TEST(SeveralIsosurfacesForC, AreThoseOfTheLibrary) {
    const std::array<double, 3> isovalues{0.3, 0.1, 0.2};
    for_each_scene([&](auto& scene) {
        scene.options.threshold = 0.05;
        std::array<nestgrid_surface, 3> several{};
        ASSERT_EQ(nestgrid_isosurfaces(&scene.in_c.table, &scene.field, isovalues.size(),
                                       isovalues.data(), &scene.options, several.data(),
                                       scene.message.data(), scene.message.size()),
                  0)
            << scene.message.data();
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        const auto direct = isosurfaces(scene.grid, scene.first, isovalues, under(offsets, 0.05),
                                        {.elements = false});
        for (std::size_t i = 0; i < isovalues.size(); ++i) {
            nestgrid_surface_details details{};
            details.size = sizeof(details);
            ASSERT_EQ(nestgrid_details(&several[i], &details, nullptr, 0), 0);
            EXPECT_EQ(details.threshold, 0.05);
            expect_same(several[i], direct[i]);
        }
    });
}

TEST(BandsForC, AreThoseOfTheLibrary) {
    for_each_scene([](auto& scene) {
        scene.options.threshold = 0.05;
        nestgrid_surface surface{};
        ASSERT_EQ(nestgrid_isoband(&scene.in_c.table, &scene.field, 0.1, 0.3, &scene.options,
                                   &surface, scene.message.data(), scene.message.size()),
                  0)
            << scene.message.data();
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        expect_same(surface, isoband(scene.grid, scene.first, 0.1, 0.3, under(offsets, 0.05),
                                     {.elements = false}));
    });
}

TEST(IsosurfacesForC, HaveAttributesOfAnotherType) {
    Scene<3> scene(forests<3>()[0]);
    scene.ask_for_attribute();
    // The same numbers in float, which the library widens.
    nestgrid_field narrow = scene.second_field;
    struct Self {
        const nestgrid_field* wide;
    } const self{&scene.second_field};
    narrow.self = &self;
    narrow.value_type = NESTGRID_FLOAT;
    narrow.coarse_values = [](const void* s, void* c, std::size_t i, std::size_t n, void* out,
                              std::uint64_t* missing) {
        std::vector<double> values(n);
        const nestgrid_field& wide = *static_cast<const Self*>(s)->wide;
        const int code = wide.coarse_values(wide.self, c, i, n, values.data(), missing);
        for (std::size_t k = 0; k < n; ++k) {
            static_cast<float*>(out)[k] = static_cast<float>(values[k]);
        }
        return code;
    };
    narrow.new_values = [](const void* s, void* c, const nestgrid_element* e, std::uint64_t which,
                           std::size_t n, void* out, std::uint64_t* missing) {
        std::vector<double> values(n);
        const nestgrid_field& wide = *static_cast<const Self*>(s)->wide;
        const int code = wide.new_values(wide.self, c, e, which, n, values.data(), missing);
        for (std::size_t k = 0; k < n; ++k) {
            static_cast<float*>(out)[k] = static_cast<float>(values[k]);
        }
        return code;
    };
    const nestgrid_field* only = &narrow;
    scene.options.attributes = &only;
    nestgrid_surface surface = draw(scene);
    for (double& x : scene.second.values) x = static_cast<float>(x);
    Prerolls prerolls(FieldOnGrid(scene.grid, scene.both));
    expect_same(surface, isosurface<3>(prerolls, isovalue, {}, {.elements = false}));
}

TEST(PrerollsForC, ServeSeveralCalls) {
    Scene<3> scene(forests<3>()[0]);
    ASSERT_EQ(nestgrid_prerolls_make(&scene.options.prerolls, nullptr, 0), 0);
    scene.options.threshold = 0.1;
    const HierarchicalIndicator offsets(scene.grid, scene.first);
    const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
    const SweptIndicator visual = visual_indicator({scene.grid, scene.first});
    for (int i = 0; i < 2; ++i) {
        scene.options.indicator = NESTGRID_OFFSET;
        nestgrid_surface surface = draw(scene);
        expect_same(surface, draw_directly(scene, Threshold(&offsets, 0.1), offsets));
        scene.options.indicator = NESTGRID_DEVIATION;
        surface = draw(scene);
        expect_same(surface, draw_directly(scene, Threshold(&deviations, 0.1), deviations));
        scene.options.indicator = NESTGRID_VISUAL;
        surface = draw(scene);
        expect_same(surface, draw_directly(scene, Threshold(&visual, 0.1), offsets));
    }
    // Nothing is walked anew: values that changed meanwhile are not seen by the indicator.
    for (double& v : scene.first.values) v *= 100;
    scene.options.indicator = NESTGRID_OFFSET;
    nestgrid_surface surface = draw(scene);
    expect_same(surface, draw_directly(scene, Threshold(&offsets, 0.1), offsets));

    scene.field = scene.second_field;
    nestgrid_surface none;
    EXPECT_EQ(nestgrid_isosurface_with(&scene.in_c.table, &scene.field, isovalue, &scene.options,
                                       &none, scene.message.data(), 200),
              1);
    EXPECT_STREQ(scene.message.data(), "the prerolls were made for another grid or field");
    nestgrid_prerolls_free(scene.options.prerolls);
    nestgrid_prerolls_free(nullptr);
}

TEST(IsosurfacesForC, EndWhereTheCallerSaysSo) {
    Scene<3> scene(forests<3>()[0]);
    int calls = 0;
    scene.options.threads = 2;
    scene.options.progress_data = &calls;
    scene.options.progress = [](void* data, std::uint64_t, std::uint64_t) {
        return ++*static_cast<int*>(data);
    };
    nestgrid_surface surface = draw(scene);
    nestgrid_surface_details d{};
    d.size = sizeof(d);
    ASSERT_EQ(nestgrid_details(&surface, &d, nullptr, 0), 0);
    EXPECT_EQ(d.cancelled, 1);
    EXPECT_EQ(calls, 1);
    nestgrid_surface_free(&surface);
}

TEST(ThreadsForC, WorkOnceAndInOrder) {
    for (const int threads : {1, 2, 7}) {
        expect_parts_once_and_in_order(engine::ThreadExecutor(threads));
    }
    engine::ThreadExecutor(3).run(
        0, [](std::size_t) { FAIL(); }, [](std::size_t) { FAIL(); });
}

TEST(ThreadsForC, PassOnWhatIsThrown) {
    std::atomic<int> begun = 0;
    const auto fail_at_nine = [&](std::size_t i) {
        ++begun;
        if (i == 9) throw InvalidInput("nine");
    };
    const auto nothing = [](std::size_t) {};
    EXPECT_THROW(engine::ThreadExecutor(4).run(1000, fail_at_nine, nothing), InvalidInput);
    EXPECT_LT(begun, 100);
    EXPECT_THROW(engine::ThreadExecutor(4).run(1000, nothing, fail_at_nine), InvalidInput);
}

}  // namespace c_algorithms_test
