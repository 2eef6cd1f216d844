// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/triangle_sides.hpp>
#include <surfaces/triangle_terms.hpp>

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

}  // namespace

SurfaceMeasures engine::measures_of(std::span<const double> sums) {
    SurfaceMeasures measures;
    measures.triangles = static_cast<std::size_t>(sums[0]);
    measures.area = sums[1];
    measures.area_vector = {sums[2], sums[3], sums[4]};
    measures.volume = sums[5];
    measures.integrals.assign(sums.begin() + first_integral, sums.end());
    return measures;
}

void engine::require_vector(std::size_t attributes, std::size_t first) {
    if (attributes >= first + 3) return;
    throw InvalidInput("the surface has " + std::to_string(attributes) +
                       " attributes, too few for a vector field from number " +
                       std::to_string(first) + " on");
}

SurfaceMeasurement measure_surface(const Surface<3>& surface) {
    SurfaceMeasurement result;
    result.component_of = number_components(surface);
    const std::size_t terms = engine::first_integral + attribute_count(surface);
    const Point origin = engine::origin_of(surface);
    std::vector<engine::ExactSum> total(terms);
    std::vector<double> sums(terms);
    engine::sum_by_component<std::uint32_t>(
        result.component_of, terms,
        [&](std::size_t t, std::span<double> out) {
            engine::measure_triangle(surface, t, origin, out);
        },
        [&](std::uint32_t, std::size_t term, engine::ExactSum& sum) {
            sum.for_each_part([&](double part) { total[term].add(part); });
            sums[term] = sum.value();
            if (term + 1 == terms) result.components.push_back(engine::measures_of(sums));
        });
    for (std::size_t k = 0; k < terms; ++k) sums[k] = total[k].value();
    result.total = engine::measures_of(sums);
    const std::vector<bool> open = open_vertices(surface);
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        for (const std::uint32_t v : surface.simplices[t]) {
            if (open[v]) result.components[result.component_of[t]].closed = false;
        }
    }
    for (const SurfaceMeasures& of : result.components) {
        result.total.closed = result.total.closed && of.closed;
    }
    return result;
}

std::vector<double> flux(const Surface<3>& surface, const SurfaceMeasurement& measured,
                         std::size_t first) {
    const std::size_t attributes = attribute_count(surface);
    if (!surface.vertices.empty()) engine::require_vector(attributes, first);
    std::vector<double> result(measured.components.size(), 0.0);
    engine::sum_by_component<std::uint32_t>(
        measured.component_of, 1,
        [&](std::size_t t, std::span<double> out) {
            out[0] = engine::flux_through(surface, t, attributes, first);
        },
        [&](std::uint32_t component, std::size_t, engine::ExactSum& sum) {
            result[component] = sum.value();
        });
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
