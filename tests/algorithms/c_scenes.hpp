// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Grids, fields and options as C++ codes and as C codes have them, and results of both compared.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <nestgrid/algorithms/isosurface.h>
#include <nestgrid/algorithms/isosurface.hpp>

#include "forest.hpp"
#include "table_in_c.hpp"

namespace c_algorithms_test {

using namespace nestgrid;
using namespace nestgrid_test;

constexpr double isovalue = 0.2;

inline double wave(const Point& x) {
    return std::sin(2 * x[0]) + std::cos(3 * x[1]) * x[2] - 0.3 * x[1];
}
inline double slope(const Point& x) { return x[0] - 2 * x[1] + x[2]; }

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
    return isosurface(scene.grid, scene.first, isovalue, under(s, bounds), {.elements = keep});
}

}  // namespace c_algorithms_test
