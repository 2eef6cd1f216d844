// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Area, enclosed volume, flux and integrals over a surface, per connected component.
//
// Everything is exact for the triangles and for functions that are linear on them, so for smooth
// data the error is of order h^2, h being the size of the elements.
#pragma once

#include <algorithm>
#include <numeric>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// One connected component of a surface, or a whole one.
struct SurfaceMeasures {
    std::size_t triangles = 0;
    double area = 0;
    Point area_vector{0, 0, 0};  ///< 0 for a closed surface
    /// Enclosed, positive around U >= C, negative around a cavity; means nothing for a component
    /// that is not closed.
    double volume = 0;
    bool closed = true;             ///< no edge belongs to one triangle only
    std::vector<double> integrals;  ///< of each attribute (component 1 ... of the field)
};

struct SurfaceMeasurement {
    std::vector<SurfaceMeasures> components;  ///< in the order of their first triangles
    std::vector<std::uint32_t> component_of;  ///< per triangle
    SurfaceMeasures total;
};

namespace detail {

/// Vertices joined by triangles: the least vertex of each component, by path halving.
inline std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
}

template <class Surface>
std::vector<bool> open_vertices(const Surface& surface) {
    std::vector<std::array<std::uint32_t, 2>> sides;
    for (const auto& t : surface.simplices) {
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
            sides.push_back({low, high});
        }
    }
    std::sort(sides.begin(), sides.end());
    std::vector<bool> open(surface.vertices.size(), false);
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i + 1;
        while (j < sides.size() && sides[j] == sides[i]) ++j;
        if (j - i == 1) open[sides[i][0]] = true;
        i = j;
    }
    return open;
}

}  // namespace detail

/// Measures a triangle surface, component by component.
template <class Element>
SurfaceMeasurement measure_surface(const Surface<3, Element>& surface) {
    const std::size_t vertices = surface.vertices.size();
    const std::size_t attributes = vertices == 0 ? 0 : surface.attributes.size() / vertices;
    std::vector<std::uint32_t> parent(vertices);
    std::iota(parent.begin(), parent.end(), 0U);
    for (const auto& t : surface.simplices) {
        for (const std::uint32_t v : {t[1], t[2]}) {
            const std::uint32_t a = detail::find_root(parent, t[0]);
            const std::uint32_t b = detail::find_root(parent, v);
            parent[std::max(a, b)] = std::min(a, b);
        }
    }
    const std::vector<bool> open = detail::open_vertices(surface);
    const Point origin = vertices == 0 ? Point{} : surface.vertices.front();
    constexpr std::uint32_t none = 0xFFFFFFFFU;
    std::vector<std::uint32_t> number(vertices, none);
    SurfaceMeasurement result;
    result.total.integrals.assign(attributes, 0.0);
    for (const auto& t : surface.simplices) {
        std::uint32_t& component = number[detail::find_root(parent, t[0])];
        if (component == none) {
            component = static_cast<std::uint32_t>(result.components.size());
            result.components.emplace_back();
            result.components.back().integrals.assign(attributes, 0.0);
        }
        result.component_of.push_back(component);
        const Point a = surface.vertices[t[0]] - origin;
        const Point b = surface.vertices[t[1]] - origin;
        const Point c = surface.vertices[t[2]] - origin;
        const Point normal = 0.5 * cross(b - a, c - a);
        const double area = norm(normal);
        for (SurfaceMeasures* m : {&result.components[component], &result.total}) {
            ++m->triangles;
            m->area += area;
            m->area_vector = m->area_vector + normal;
            m->volume += dot(a, cross(b, c)) / 6;
            m->closed = m->closed && !open[t[0]] && !open[t[1]] && !open[t[2]];
            for (std::size_t i = 0; i < attributes; ++i) {
                double sum = 0;
                for (const std::uint32_t v : t) sum += surface.attributes[v * attributes + i];
                m->integrals[i] += area * sum / 3;
            }
        }
    }
    return result;
}

/// Flux of a vector field through each component, out of U >= C. The field is component `first`,
/// `first` + 1 and `first` + 2 of the attributes.
/// \throw InvalidInput where there are not so many attributes
template <class Element>
std::vector<double> flux(const Surface<3, Element>& surface, const SurfaceMeasurement& measured,
                         std::size_t first = 0) {
    const std::size_t vertices = surface.vertices.size();
    const std::size_t attributes = vertices == 0 ? 0 : surface.attributes.size() / vertices;
    if (vertices > 0 && attributes < first + 3) {
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

/// Volume of the part of the domain where low <= U < high, under the projection with a threshold:
/// the difference of two capped surfaces, of which nothing is kept.
/// \throw InvalidInput unless low <= high
template <class Grid, class Field, class Indicator>
double volume_between(const Grid& grid, const Field& field, double low, double high,
                      const Indicator& indicator, double threshold = 0) {
    static_assert(Grid::dimension == 3, "volumes need a grid of dimension 3");
    if (!(low <= high)) throw InvalidInput("the lower isovalue is not below the upper one");
    Context<Grid> context = make_context(grid);
    const Point origin = detail::call_coarse(grid, context, 0).corners[0];
    std::array<double, 2> volume{0, 0};
    const auto adder = [&origin](double* sum) {
        return [sum, &origin](const std::array<Point, 3>& x) {
            *sum += dot(x[0] - origin, cross(x[1] - origin, x[2] - origin)) / 6;
        };
    };
    using Sink = SimplexStream<3, decltype(adder(nullptr))>;
    const std::array<double, 2> isovalues{low, high};
    const Threshold<Indicator> criterion{&indicator, threshold};
    extract_isosurfaces(grid, field, std::span<const double>(isovalues),
                        std::vector<Sink>{Sink(adder(&volume[0])), Sink(adder(&volume[1]))},
                        criterion, indicator, {.cap = true});
    return volume[0] - volume[1];
}

}  // namespace nestgrid
