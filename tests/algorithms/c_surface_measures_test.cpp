// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What C codes measure of surfaces has the bits that C++ codes get, and keeps the theorem of Gauss.
#include <nestgrid/algorithms/slice.h>
#include <nestgrid/algorithms/surface_measures.h>
#include <nestgrid/algorithms/surface_measures.hpp>

#include "c_scenes.hpp"

namespace c_algorithms_test {

void expect_same(const nestgrid_measures& c, const SurfaceMeasures& direct, double flux) {
    EXPECT_EQ(c.triangles, direct.triangles);
    EXPECT_EQ(c.area, direct.area);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(c.area_vector[d], direct.area_vector[d]);
    EXPECT_EQ(c.volume, direct.volume);
    EXPECT_EQ(c.closed, direct.closed ? 1 : 0);
    EXPECT_EQ(c.flux, flux);
    for (std::size_t i = 0; i < direct.integrals.size(); ++i) {
        EXPECT_EQ(c.integrals[i], direct.integrals[i]);
    }
}

TEST(SurfaceMeasuresForC, AreTheSameAndKeepTheTheoremOfGauss) {
    for (const auto& forest : forests<3>()) {
        Scene<3> scene(forest);
        const ForestField<3> x(scene.grid, [](const Point& p) { return p[0]; });
        const ForestField<3> y(scene.grid, [](const Point& p) { return p[1]; });
        const ForestField<3> z(scene.grid, [](const Point& p) { return p[2]; });
        std::vector<nestgrid_field> tables;
        for (const auto* field : {&x, &y, &z}) tables.push_back(field_in_c(scene.grid, *field));
        const std::array<const nestgrid_field*, 3> places{&tables[0], &tables[1], &tables[2]};
        scene.options.attributes = places.data();
        scene.options.attribute_count = 3;
        scene.options.threshold = 0.02;
        scene.options.cap = 1;
        nestgrid_surface surface;
        ASSERT_EQ(nestgrid_isosurface_with(&scene.in_c.table, &scene.field, isovalue,
                                           &scene.options, &surface, scene.message.data(), 200),
                  0)
            << scene.message.data();
        Surface<3> direct;
        nestgrid_surface_details details{};
        details.size = sizeof(details);
        nestgrid_details(&surface, &details, nullptr, 0);
        for (std::size_t v = 0; v < surface.vertex_count; ++v) {
            const double* const p = surface.vertices + 3 * v;
            direct.vertices.push_back({p[0], p[1], p[2]});
            direct.attributes.insert(direct.attributes.end(), details.attributes + 3 * v,
                                     details.attributes + 3 * v + 3);
        }
        for (std::size_t t = 0; t < surface.simplex_count; ++t) {
            const std::uint32_t* const corner = surface.simplices + 3 * t;
            direct.simplices.push_back({corner[0], corner[1], corner[2]});
        }
        const SurfaceMeasurement measured = measure_surface(direct);
        const std::vector<double> fluxes = flux(direct, measured);
        nestgrid_surface_measures c{};
        c.size = sizeof(c);
        ASSERT_EQ(nestgrid_measure_surface(&surface, 0, &c, scene.message.data(), 200), 0)
            << scene.message.data();
        ASSERT_EQ(c.component_count, measured.components.size());
        ASSERT_GT(c.component_count, 0U);
        double whole = 0;
        for (std::size_t i = 0; i < c.component_count; ++i) {
            expect_same(c.components[i], measured.components[i], fluxes[i]);
            whole += fluxes[i];
            EXPECT_EQ(c.components[i].closed, 1);
            EXPECT_NEAR(c.components[i].flux, 3 * c.components[i].volume, 1e-12);
        }
        expect_same(c.whole, measured.total, whole);
        for (std::size_t t = 0; t < surface.simplex_count; ++t) {
            ASSERT_EQ(c.component_of[t], measured.component_of[t]);
        }
        nestgrid_surface_measures_free(&c);
        EXPECT_EQ(c.components, nullptr);
        EXPECT_EQ(c.size, sizeof(c));
        ASSERT_EQ(nestgrid_measure_surface(&surface, -1, &c, nullptr, 0), 0);
        EXPECT_EQ(c.whole.flux, 0);
        nestgrid_surface_measures_free(&c);
        nestgrid_surface_free(&surface);
    }
}

TEST(SurfaceMeasuresForC, SayWhatIsWrong) {
    Scene<3> scene(forests<3>()[0]);
    Scene<2> flat(forests<2>()[0]);
    std::array<char, 200> message{};
    nestgrid_surface_measures c{};
    const auto sentence = [&](const nestgrid_surface* surface, int flux_from,
                              nestgrid_surface_measures* out) {
        EXPECT_EQ(nestgrid_measure_surface(surface, flux_from, out, message.data(), 200), 1);
        return std::string(message.data());
    };
    nestgrid_surface surface;
    ASSERT_EQ(
        nestgrid_isosurface(&scene.in_c.table, &scene.field, isovalue, 0, &surface, nullptr, 0), 0);
    EXPECT_EQ(sentence(&surface, -1, nullptr), "the result is NULL");
    EXPECT_NE(sentence(&surface, -1, &c).find("size of the result"), std::string::npos);
    c.size = sizeof(c);
    EXPECT_EQ(sentence(nullptr, -1, &c), "there is no surface to measure");
    EXPECT_EQ(sentence(&surface, -2, &c), "no attribute has a number below 0");
    EXPECT_NE(sentence(&surface, 0, &c).find("attributes"), std::string::npos);
    nestgrid_surface_free(&surface);
    ASSERT_EQ(nestgrid_isosurface(&flat.in_c.table, &flat.field, isovalue, 0, &surface, nullptr, 0),
              0);
    EXPECT_EQ(sentence(&surface, -1, &c), "only surfaces in space are measured");
    nestgrid_surface_free(&surface);
}

}  // namespace c_algorithms_test
