// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Area, volume, integrals and flux of single triangles, and exact sums of them.
//
// Invariant: the terms of a triangle depend on its corners, in their order around it, and on the
// origin of the surface alone; sums of them are exact. Consequence: measures have the same bits in
// whatever order triangles are drawn, by threads or ranks.
#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <nestgrid/algorithms/surface_measures.hpp>
#include <surfaces/exact_sum.hpp>

namespace nestgrid::engine {

/// The apex of the cones whose volumes are added: the least coordinates of all triangles.
inline Point origin_of(const Surface<3>& surface) {
    constexpr double most = std::numeric_limits<double>::max();
    Point origin{most, most, most};
    for (const auto& t : surface.simplices) {
        for (const std::uint32_t v : t) {
            for (std::size_t d = 0; d < 3; ++d) {
                origin[d] = std::min(origin[d], surface.vertices[v][d]);
            }
        }
    }
    return origin;
}

/// A triangle from its least corner on: the same, whichever corner it was drawn from.
inline Surface<3>::Simplex from_least_corner(const Surface<3>& surface, Surface<3>::Simplex t) {
    const auto is_less = [&](std::uint32_t a, std::uint32_t b) {
        return surface.vertices[a] < surface.vertices[b];
    };
    std::rotate(t.begin(), std::min_element(t.begin(), t.end(), is_less), t.end());
    return t;
}

/// What a triangle adds to area vector, area and volume.
struct TriangleTerms {
    std::array<Point, 3> corner;  ///< relative to the origin
    Point normal;                 ///< whose length is the area
    double area;
    double volume;

    /// \param t from its least corner on
    TriangleTerms(const Surface<3>& surface, const Surface<3>::Simplex& t, const Point& origin) {
        for (std::size_t k = 0; k < 3; ++k) corner[k] = surface.vertices[t[k]] - origin;
        normal = 0.5 * cross(corner[1] - corner[0], corner[2] - corner[0]);
        area = norm(normal);
        volume = dot(corner[0], cross(corner[1], corner[2])) / 6;
    }
};

/// The terms of the measures of a surface, in this order: number, area, area vector, volume, the
/// integral of each attribute.
inline constexpr std::size_t first_integral = 6;
inline void measure_triangle(const Surface<3>& surface, std::size_t triangle, const Point& origin,
                             std::span<double> out) {
    const auto t = from_least_corner(surface, surface.simplices[triangle]);
    const TriangleTerms terms(surface, t, origin);
    const auto& n = terms.normal;
    const std::array<double, first_integral> geometry{1,    terms.area, n[0],
                                                      n[1], n[2],       terms.volume};
    std::copy(geometry.begin(), geometry.end(), out.begin());
    const std::size_t attributes = out.size() - first_integral;
    for (std::size_t i = 0; i < attributes; ++i) {
        double sum = 0;
        for (const std::uint32_t v : t) sum += surface.attributes[v * attributes + i];
        out[first_integral + i] = terms.area * sum / 3;
    }
}

/// The measures of which these are the terms, of a closed surface.
SurfaceMeasures measures_of(std::span<const double> sums);

/// \throw InvalidInput where a vertex has too few attributes for a vector from number `first` on
void require_vector(std::size_t attributes, std::size_t first);

/// The flux through a triangle of the attributes `first` to `first` + 2.
/// \param attributes of a vertex
inline double flux_through(const Surface<3>& surface, std::size_t triangle, std::size_t attributes,
                           std::size_t first) {
    const auto t = from_least_corner(surface, surface.simplices[triangle]);
    const TriangleTerms terms(surface, t, surface.vertices[t[0]]);
    double flux = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        double sum = 0;
        for (const std::uint32_t v : t) sum += surface.attributes[v * attributes + first + d];
        flux += terms.normal[d] * sum / 3;
    }
    return flux;
}

/// Adds up what triangles say, component by component.
/// \param component_of per triangle
/// \param terms terms(triangle, out) writes the terms of a triangle, as many as `out` holds
/// \param take take(component, term, sum), in this order, for components that have triangles
template <class Component, class Terms, class Take>
void sum_by_component(std::span<const Component> component_of, std::size_t term_count,
                      const Terms& terms, const Take& take) {
    std::vector<std::uint32_t> order(component_of.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto component = [&](std::uint32_t t) { return component_of[t]; };
    std::ranges::stable_sort(order, {}, component);
    std::vector<double> of_triangle(term_count);
    for (std::size_t i = 0; i < order.size();) {
        std::vector<ExactSum> sums(term_count);
        const Component at = component(order[i]);
        for (; i < order.size() && component(order[i]) == at; ++i) {
            terms(order[i], std::span(of_triangle));
            for (std::size_t k = 0; k < term_count; ++k) sums[k].add(of_triangle[k]);
        }
        for (std::size_t k = 0; k < term_count; ++k) take(at, k, sums[k]);
    }
}

}  // namespace nestgrid::engine
