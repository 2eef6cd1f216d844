// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/surface_measures.hpp>
#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/triangle_sides.hpp>

namespace nestgrid {

namespace {

std::size_t attribute_count(const Surface<3>& surface) {
    return surface.vertices.empty() ? 0 : surface.attributes.size() / surface.vertices.size();
}

/// Marks the lower end of every edge that belongs to one triangle only.
std::vector<bool> open_vertices(const Surface<3>& surface) {
    std::vector<bool> open(surface.vertices.size(), false);
    engine::for_each_edge(engine::sorted_sides(surface.simplices),
                          [&](std::span<const engine::OrientedSide> edge) {
                              if (edge.size() == 1) open[edge[0].low] = true;
                          });
    return open;
}

/// Numbers the components in the order of their first triangles; one number per triangle.
std::vector<std::uint32_t> number_components(const Surface<3>& surface) {
    detail::UnionFind joined(surface.vertices.size());
    for (const auto& t : surface.simplices) {
        joined.join(t[0], t[1]);
        joined.join(t[0], t[2]);
    }
    constexpr std::uint32_t none = 0xFFFFFFFFU;
    std::vector<std::uint32_t> number(surface.vertices.size(), none);
    std::vector<std::uint32_t> component_of;
    std::uint32_t count = 0;
    for (const auto& t : surface.simplices) {
        std::uint32_t& component = number[joined.root(t[0])];
        if (component == none) component = count++;
        component_of.push_back(component);
    }
    return component_of;
}

/// Adds a triangle to measures.
/// \param origin apex of the cones whose volumes are added
void add_triangle(const Surface<3>& surface, const std::array<std::uint32_t, 3>& t,
                  const Point& origin, const std::vector<bool>& open, SurfaceMeasures& to) {
    const Point a = surface.vertices[t[0]] - origin;
    const Point b = surface.vertices[t[1]] - origin;
    const Point c = surface.vertices[t[2]] - origin;
    const Point normal = 0.5 * cross(b - a, c - a);
    const double area = norm(normal);
    ++to.triangles;
    to.area += area;
    to.area_vector = to.area_vector + normal;
    to.volume += dot(a, cross(b, c)) / 6;
    to.closed = to.closed && !open[t[0]] && !open[t[1]] && !open[t[2]];
    const std::size_t attributes = to.integrals.size();
    for (std::size_t i = 0; i < attributes; ++i) {
        double sum = 0;
        for (const std::uint32_t v : t) sum += surface.attributes[v * attributes + i];
        to.integrals[i] += area * sum / 3;
    }
}

}  // namespace

SurfaceMeasurement measure_surface(const Surface<3>& surface) {
    const std::vector<bool> open = open_vertices(surface);
    const Point origin = surface.vertices.empty() ? Point{} : surface.vertices.front();
    SurfaceMeasures nothing;
    nothing.integrals.assign(attribute_count(surface), 0.0);
    SurfaceMeasurement result;
    result.total = nothing;
    result.component_of = number_components(surface);
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const std::uint32_t component = result.component_of[t];
        if (component == result.components.size()) result.components.push_back(nothing);
        for (SurfaceMeasures* const to : {&result.components[component], &result.total}) {
            add_triangle(surface, surface.simplices[t], origin, open, *to);
        }
    }
    return result;
}

std::vector<double> flux(const Surface<3>& surface, const SurfaceMeasurement& measured,
                         std::size_t first) {
    const std::size_t attributes = attribute_count(surface);
    if (!surface.vertices.empty() && attributes < first + 3) {
        throw InvalidInput("the surface has " + std::to_string(attributes) +
                           " attributes, too few for a vector field from number " +
                           std::to_string(first) + " on");
    }
    std::vector<double> result(measured.components.size(), 0.0);
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& of = surface.simplices[t];
        const Point& x = surface.vertices[of[0]];
        const Point normal = 0.5 * cross(surface.vertices[of[1]] - x, surface.vertices[of[2]] - x);
        for (std::size_t d = 0; d < 3; ++d) {
            double sum = 0;
            for (const std::uint32_t v : of) sum += surface.attributes[v * attributes + first + d];
            result[measured.component_of[t]] += normal[d] * sum / 3;
        }
    }
    return result;
}

double volume_between(const Prerolls& prerolls, double low, double high,
                      const Projection& projection, const Work& work) {
    if (!(low <= high)) throw InvalidInput("the lower isovalue is not below the upper one");
    const FieldOnGrid& field = prerolls.field();
    field.facts().require_dimension(3);
    field.facts().require_one_process("a volume between isovalues");
    Coarse coarse;
    Family family;
    field.visit([&](const auto& hierarchy) {
        hierarchy.coarse(hierarchy.open().get(), 0, coarse, family);
    });
    const Point origin = coarse.corners[0];
    std::array<double, 2> volume{0, 0};
    const auto adder = [&origin](double* sum) {
        return SimplexStream<3>([sum, &origin](const std::array<Point, 3>& x) {
            *sum += dot(x[0] - origin, cross(x[1] - origin, x[2] - origin)) / 6;
        });
    };
    const std::array<double, 2> isovalues{low, high};
    extract_isosurfaces<3>(prerolls, isovalues, std::vector{adder(&volume[0]), adder(&volume[1])},
                           projection, {.cap = true}, work);
    return volume[0] - volume[1];
}

}  // namespace nestgrid
