// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whatever C codes ask for by options, they get the bits that C++ codes get; refusals are
// sentences.
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isolines.h>
#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/algorithms/probe.h>
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/norm_indicator.hpp>
#include <nestgrid/algorithms/numerical_indicator.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/slice.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/algorithms/visual_indicator.hpp>
#include <nestgrid/algorithms/wavelet_indicator.hpp>

#include <threads/thread_executor.hpp>

#include "executor_laws.hpp"
#include "forest.hpp"
#include "table_in_c.hpp"

using namespace nestgrid;
using namespace nestgrid_test;

namespace c_algorithms_test {

constexpr double isovalue = 0.2;

double wave(const Point& x) { return std::sin(2 * x[0]) + std::cos(3 * x[1]) * x[2] - 0.3 * x[1]; }
double slope(const Point& x) { return x[0] - 2 * x[1] + x[2]; }

/// Two fields as one of two components.
template <class Field>
struct Joined {
    using value_type = double;
    static constexpr int components = 2;

    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<double, max_corners> a{};
        std::array<double, max_corners> b{};
        const NodeMask missing = first->coarse_values(i, a) | second->coarse_values(i, b);
        for (std::size_t k = 0; 2 * k < out.size(); ++k) {
            out[2 * k] = a[k];
            out[2 * k + 1] = b[k];
        }
        return missing;
    }
    NodeMask new_values(std::uint32_t e, NodeMask which, std::span<double> out) const {
        std::array<double, max_new_nodes> a{};
        std::array<double, max_new_nodes> b{};
        const NodeMask missing = first->new_values(e, which, a) | second->new_values(e, which, b);
        for (std::size_t n = 0; 2 * n < out.size(); ++n) {
            out[2 * n] = a[n];
            out[2 * n + 1] = b[n];
        }
        return missing;
    }
    const Field* first;
    const Field* second;
};

template <int dim>
class Scene {
    using Field = ForestField<dim>;

public:
    explicit Scene(Forest<dim> made) : grid{std::move(made)} { options.size = sizeof(options); }

    /// Asks for the second field, too.
    void ask_for_attribute() {
        options.attributes = &second_in_c;
        options.attribute_count = 1;
    }

    Forest<dim> grid;
    Field first{grid, wave};
    Field second{grid, slope};
    Joined<Field> both{&first, &second};
    TableInC<Forest<dim>> in_c{grid};
    nestgrid_field field{field_in_c(grid, first)};
    nestgrid_field second_field{field_in_c(grid, second)};
    const nestgrid_field* second_in_c = &second_field;
    nestgrid_options options{};
    std::array<char, 200> message{};
};

template <int dim>
std::vector<Forest<dim>> forests() {
    std::vector<Forest<dim>> all;
    std::mt19937 random(5);
    all.push_back(boxes<dim>(random, 2));
    all.push_back(boxes<dim>(random, 1));
    all.push_back(kuhn<dim>(dim == 2 ? 2 : 0));  // bisected, or red
    for (Forest<dim>& forest : all) refine_randomly(forest, random, dim == 3 ? 150 : 300);
    return all;
}

/// Calls function(scene) for several grids of each dimension.
template <class Function>
void for_each_scene(const Function& function) {
    for (const auto& forest : forests<2>()) {
        Scene<2> scene(forest);
        function(scene);
    }
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        function(scene);
    }
}

template <class T>
void expect_points(const T* rows, const std::vector<Point>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t d = 0; d < 3; ++d) ASSERT_EQ(rows[3 * i + d], points[i][d]);
    }
}

template <int dimension>
void expect_same_details(const nestgrid_surface& surface, const Surface<dimension>& s) {
    nestgrid_surface_details d{};
    d.size = sizeof(d);
    ASSERT_EQ(nestgrid_details(&surface, &d, nullptr, 0), 0);
    ASSERT_EQ(d.normals != nullptr, !s.normals.empty());
    if (d.normals != nullptr) expect_points(d.normals, s.normals);
    ASSERT_EQ(d.attribute_count * surface.vertex_count, s.attributes.size());
    for (std::size_t i = 0; i < s.attributes.size(); ++i) {
        ASSERT_EQ(d.attributes[i], s.attributes[i]);
    }
    ASSERT_EQ(d.element_count, s.elements.size());
    if (d.element_count > 0) {
        const auto elements = s.elements.template as<std::uint32_t>();
        for (std::size_t i = 0; i < d.element_count; ++i) {
            ASSERT_EQ(std::memcmp(&d.elements[i], &elements[i], sizeof(elements[i])), 0);
            ASSERT_EQ(d.shapes[i], static_cast<int>(s.shape_of[i]));
            ASSERT_EQ(d.levels[i], s.level_of[i]);
        }
        for (std::size_t i = 0; i < s.element_of.size(); ++i) {
            ASSERT_EQ(d.element_of[i], s.element_of[i]);
        }
    }
    ASSERT_EQ(d.reference != nullptr, !s.reference.empty());
    for (std::size_t i = 0; i < 3 * s.reference.size(); ++i) {
        const double direct = s.reference[i / 3][i % 3];
        ASSERT_TRUE(d.reference[i] == direct || (std::isnan(d.reference[i]) && std::isnan(direct)));
    }
    ASSERT_EQ(d.boundary_count, s.boundary.size());
    for (std::size_t i = 0; i < s.boundary.size(); ++i) {
        ASSERT_EQ(d.boundary[i * s.boundary[i].size()], s.boundary[i][0]);
    }
}

template <class Result>
void expect_same(nestgrid_surface& surface, const Result& direct) {
    const auto& s = direct.surface;
    constexpr std::size_t corners = std::tuple_size_v<typename decltype(s.simplices)::value_type>;
    ASSERT_GT(surface.simplex_count, 0U);
    ASSERT_EQ(surface.vertex_count, s.vertices.size());
    ASSERT_EQ(surface.simplex_count, s.simplices.size());
    ASSERT_EQ(surface.dimension, static_cast<int>(corners));
    ASSERT_EQ(surface.error_bound, direct.error_bound);
    ASSERT_EQ(surface.visited, direct.counts.visited);
    expect_points(surface.vertices, s.vertices);
    for (std::size_t i = 0; i < surface.simplex_count; ++i) {
        for (std::size_t k = 0; k < corners; ++k) {
            ASSERT_EQ(surface.simplices[corners * i + k], s.simplices[i][k]);
        }
    }
    expect_same_details(surface, s);
    nestgrid_surface_free(&surface);
}

/// Draws by the tables of a scene and its options.
template <int dim>
nestgrid_surface draw(Scene<dim>& scene) {
    nestgrid_surface surface;
    EXPECT_EQ(nestgrid_isosurface_with(&scene.in_c.table, &scene.field, isovalue, &scene.options,
                                       &surface, scene.message.data(), scene.message.size()),
              0)
        << scene.message.data();
    return surface;
}

/// Draws as C++ codes do.
template <int dim>
auto draw_directly(const Scene<dim>& scene, const Criterion& s, const Bounds& bounds,
                   bool keep = false) {
    return isosurface(scene.grid, scene.first, isovalue, s, bounds, {.elements = keep});
}

TEST(IsosurfacesForC, KeepWhatOptionsAskFor) {
    for_each_scene([](auto& scene) {
        scene.ask_for_attribute();
        scene.options.threshold = 0.05;
        scene.options.normals = scene.options.elements = scene.options.reference = 1;
        scene.options.cap = 1;
        scene.options.threads = 1;
        const auto direct =
            isosurface(scene.grid, scene.both, isovalue,
                       {.threshold = 0.05, .normals = true, .cap = true, .reference = true});
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
        expect_same(surface, isosurface(scene.grid, scene.first, isovalue,
                                        {.elements = false, .at_nodes = true}));
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
        expect(NESTGRID_NUMERICAL, numerical_indicator(scene.grid, scene.first), offsets);
        expect(NESTGRID_WAVELET, wavelet_indicator(scene.grid, scene.first), offsets);
        expect(NESTGRID_VISUAL, visual_indicator(scene.grid, scene.first), offsets);
        expect(NESTGRID_NORM, norm_indicator(scene.grid, scene.first), offsets);
        expect(NESTGRID_CUT, cut_deviations(scene.grid, scene.first, levels, offsets), offsets);
        expect(NESTGRID_SLOPE, slope_deviations(scene.grid, scene.first, levels, offsets), offsets);
    });
}

TEST(IsosurfacesForC, KeepAnError) {
    for_each_scene([](auto& scene) {
        scene.options.error = 0.1;
        const double level = isovalue;
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
        const auto cuts = cut_deviations(scene.grid, scene.first, std::span(&level, 1), offsets);
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
        const auto search = find_threshold(scene.grid, scene.first, isovalue, offsets, 60);
        nestgrid_surface_details d{};
        d.size = sizeof(d);
        ASSERT_EQ(nestgrid_details(&surface, &d, nullptr, 0), 0);
        EXPECT_EQ(d.threshold, search.threshold);
        EXPECT_EQ(d.budget_text, search.reason());
        EXPECT_LE(surface.simplex_count, 60U);
        expect_same(surface, isosurface(scene.grid, scene.first, isovalue,
                                        {.max_triangles = 60, .elements = false}));
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
    expect_same(surface, isosurface(scene.grid, scene.both, isovalue, {.elements = false}));
}

TEST(PrerollsForC, ServeSeveralCalls) {
    Scene<3> scene(forests<3>()[0]);
    ASSERT_EQ(nestgrid_prerolls_make(&scene.options.prerolls, nullptr, 0), 0);
    scene.options.threshold = 0.1;
    const HierarchicalIndicator offsets(scene.grid, scene.first);
    const HierarchicalIndicator deviations(scene.grid, scene.first, NodeError::deviation);
    const SweptIndicator visual = visual_indicator(scene.grid, scene.first);
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
        expect_same(surface,
                    slice(scene.grid, scene.both, plane, Threshold(&deviations, 0.1), deviations));
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
            const auto direct = slice(scene.grid, scene.first, sphere, {.elements = false});
            ASSERT_GT(direct.surface.simplices.size(), 0U);
            EXPECT_EQ(surface.simplex_count, direct.surface.simplices.size());
            EXPECT_EQ(surface.visited == direct.counts.visited, bounded);
            nestgrid_surface_free(&surface);
        }
    }
}

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

TEST(ProbesForC, AreTheSame) {
    for_each_scene([](auto& scene) {
        scene.ask_for_attribute();
        constexpr bool plane = std::remove_cvref_t<decltype(scene.grid)>::dimension == 2;
        std::vector<Point> points{{-3, 0, 0}};
        std::mt19937 random(3);
        std::uniform_real_distribution<double> any(0.1, 0.9);
        for (int i = 0; i < 50; ++i) {
            points.push_back({any(random), any(random), plane ? 0 : any(random)});
        }
        const HierarchicalIndicator offsets(scene.grid, scene.first);
        for (const double threshold : {0.0, 0.2}) {
            scene.options.threshold = threshold;
            nestgrid_probed probed{};
            probed.size = sizeof(probed);
            ASSERT_EQ(
                nestgrid_probe(&scene.in_c.table, &scene.field, points[0].data(), points.size(),
                               &scene.options, &probed, scene.message.data(), 200),
                0)
                << scene.message.data();
            const ProbeResult direct = threshold == 0
                                           ? probe(scene.grid, scene.both, points)
                                           : probe(scene.grid, scene.both, points,
                                                   Threshold(&offsets, threshold), offsets);
            ASSERT_EQ(probed.point_count, points.size());
            ASSERT_EQ(probed.component_count, 2U);
            EXPECT_EQ(probed.found, 50U);
            EXPECT_EQ(probed.levels[0], -1);
            EXPECT_EQ(probed.element_of[0], NESTGRID_NO_ELEMENT);
            EXPECT_TRUE(std::isnan(probed.values[0]));
            const auto elements = direct.elements.template as<std::uint32_t>();
            for (std::size_t i = 1; i < points.size(); ++i) {
                ASSERT_EQ(probed.values[2 * i], direct.values[2 * i]);
                ASSERT_EQ(probed.values[2 * i + 1], direct.values[2 * i + 1]);
                ASSERT_EQ(probed.levels[i], direct.level[i]);
                ASSERT_EQ(probed.reference[3 * i], direct.reference[i][0]);
                const std::uint32_t e = probed.element_of[i];
                ASSERT_EQ(e, direct.element_of[i]);
                ASSERT_EQ(std::memcmp(&probed.elements[e], &elements[e], sizeof(elements[e])), 0);
                ASSERT_EQ(probed.shapes[e], static_cast<int>(direct.shape_of[e]));
            }
            nestgrid_probed_free(&probed);
            EXPECT_EQ(probed.values, nullptr);
        }
    });
}

class RefusalsForC : public ::testing::Test {
protected:
    /// What a call says that is refused, which leaves nothing to be freed.
    template <class Call>
    std::string refusal(const Call& call) {
        message.fill('x');
        EXPECT_NE(call(message.data(), message.size()), 0);
        return message.data();
    }
    std::string isosurface_says() {
        return refusal([&](char* text, std::size_t size) {
            nestgrid_surface surface;
            const int code = nestgrid_isosurface_with(&solid.in_c.table, &solid.field, 0.2,
                                                      &options, &surface, text, size);
            EXPECT_EQ(surface.owner, nullptr);
            return code;
        });
    }
    std::string lines_say(const double* values = nullptr, std::size_t count = 0) {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_isolines(&plane.in_c.table, &plane.field, values, count, &options,
                                     &lines, text, size);
        });
    }
    std::string probe_says(const double* points, std::size_t count) {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_probe(&solid.in_c.table, &solid.field, points, count, &options, &probed,
                                  text, size);
        });
    }
    std::string slice_says(const nestgrid_level_function* function) {
        return refusal([&](char* text, std::size_t size) {
            nestgrid_surface surface;
            return nestgrid_slice_along(&solid.in_c.table, &solid.field, function, &options,
                                        &surface, text, size);
        });
    }
    void start_again() {
        options = {};
        options.size = sizeof(options);
    }
    void SetUp() override {
        start_again();
        lines.size = sizeof(lines);
        probed.size = sizeof(probed);
    }

    Scene<3> solid{kuhn<3>(0)};
    Scene<2> plane{kuhn<2>(0)};
    nestgrid_options options{};
    nestgrid_lines lines{};
    nestgrid_probed probed{};
    std::array<char, 200> message{};
};

TEST_F(RefusalsForC, OfOptionsAreSentences) {
    options.size = 3;
    EXPECT_EQ(isosurface_says(),
              "the size of the options says 3 bytes: set it to that of the struct");
    start_again();
    options.threshold = std::nan("");
    EXPECT_EQ(isosurface_says(), "the threshold is negative or not a number");
    start_again();
    options.error = -1;
    EXPECT_EQ(isosurface_says(), "the error is negative or not a number");
    options.error = options.threshold = 1;
    EXPECT_EQ(isosurface_says(), "an error and a threshold are asked for: give one of them");
    options.threshold = 0;
    options.indicator = NESTGRID_VISUAL;
    EXPECT_EQ(isosurface_says(), "an error is asked for, which has an indicator of its own");
    options.indicator = NESTGRID_OFFSET;
    options.max_triangles = 7;
    EXPECT_EQ(isosurface_says(),
              "a number of triangles is asked for beside an error or a threshold: give one of "
              "them");
    start_again();
    options.max_triangles = 1;
    EXPECT_NE(isosurface_says().find("triangles"), std::string::npos);
    start_again();
    options.indicator = NESTGRID_NORM + 1;
    EXPECT_EQ(isosurface_says(), "the indicator 9 does not exist");
    options.indicator = NESTGRID_GEOMETRY;
    EXPECT_EQ(isosurface_says(),
              "the indicator geometry is for curved grids: on this one it is 0 everywhere");
    start_again();
    options.threads = -2;
    EXPECT_EQ(isosurface_says(), "-2 threads are asked for, not -1 to 1024");
}

TEST_F(RefusalsForC, OfAttributesAreSentences) {
    options.attribute_count = 1;
    EXPECT_EQ(isosurface_says(), "there are attributes, but the list of their tables is NULL");
    const nestgrid_field* none = nullptr;
    options.attributes = &none;
    EXPECT_EQ(isosurface_says(), "the table of an attribute is NULL");
}

TEST_F(RefusalsForC, OfLinesAreSentences) {
    const double value = 0.2;
    EXPECT_EQ(lines_say(nullptr, 2), "the values of the isolines are NULL");
    options.max_triangles = 10;
    EXPECT_EQ(lines_say(&value, 1),
              "a limit of segments is for one isoline: take nestgrid_isosurface_with");
    start_again();
    const double wrong = std::nan("");
    EXPECT_EQ(lines_say(&wrong, 1), "the isovalue is not a finite number");
    lines.size = 8;
    EXPECT_EQ(lines_say(&value, 1),
              "the size of the result says 8 bytes: set it to that of the struct");
    lines.size = sizeof(lines);
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_isolines(&solid.in_c.table, &solid.field, &value, 1, nullptr,
                                           &lines, text, size);
              }),
              "the hierarchy has dimension 3, not 2");
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_surface_isolines(nullptr, 0, &value, 1, &lines, text, size);
              }),
              "there is no surface of triangles to draw isolines on");
}

TEST_F(RefusalsForC, OfSlicesAreSentences) {
    EXPECT_EQ(slice_says(nullptr), "the level function is NULL");
    nestgrid_level_function function{};
    function.size = 8;
    EXPECT_EQ(slice_says(&function),
              "the table of the level function is too small: its size says 8 bytes");
    function.size = sizeof(function);
    EXPECT_EQ(slice_says(&function), "the table of the level function lacks the function 'value'");
    function.value = [](const void*, const double*, double*) { return 7; };
    EXPECT_EQ(slice_says(&function),
              "the operation 'value' of the level function failed with code 7");
    options.threshold = 0.1;
    options.indicator = NESTGRID_CUT;
    EXPECT_EQ(slice_says(&function),
              "the indicator cut is for isosurfaces and isolines with given values");
    nestgrid_surface surface;
    EXPECT_EQ(refusal([&](char* text, std::size_t size) {
                  return nestgrid_slice(&solid.in_c.table, &solid.field, nullptr, nullptr, nullptr,
                                        &surface, text, size);
              }),
              "the point or the normal of the plane is NULL");
}

TEST_F(RefusalsForC, OfProbesAreSentences) {
    const Point far{std::nan(""), 0, 0};
    EXPECT_EQ(probe_says(nullptr, 1), "the points are NULL");
    EXPECT_NE(probe_says(far.data(), 1).find("finite"), std::string::npos) << message.data();
    options.max_triangles = 3;
    EXPECT_EQ(probe_says(far.data(), 1),
              "a number of triangles is asked for, but a probe draws none");
}

TEST_F(RefusalsForC, OfDetailsAreSentences) {
    nestgrid_surface surface{};
    nestgrid_surface_details details{};
    const auto says = [&] {
        return refusal([&](char* text, std::size_t size) {
            return nestgrid_details(&surface, &details, text, size);
        });
    };
    EXPECT_EQ(says(), "the details are NULL, or their size is not that of the struct");
    details.size = sizeof(details);
    EXPECT_EQ(says(), "there is no surface to tell details of");
}

TEST(ResultsForC, AreWrittenAsFarAsTheirSizeSays) {
    Scene<3> scene(forests<3>()[0]);
    const Point x{0.5, 0.5, 0.5};
    nestgrid_probed probed{};
    probed.size = offsetof(nestgrid_probed, component_count);
    probed.component_count = 99;
    ASSERT_EQ(
        nestgrid_probe(&scene.in_c.table, &scene.field, x.data(), 1, nullptr, &probed, nullptr, 0),
        0);
    EXPECT_EQ(probed.found, 1U);
    EXPECT_EQ(probed.component_count, 99U);
    EXPECT_EQ(probed.size, offsetof(nestgrid_probed, component_count));
    nestgrid_probed_free(&probed);
    EXPECT_EQ(probed.component_count, 99U);
}

}  // namespace c_algorithms_test
