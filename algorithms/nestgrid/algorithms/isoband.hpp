// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The band between two isovalues, as one mesh: the level sets around low <= U < high, both oriented
// away from the band.
#pragma once

#include <algorithm>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// Appends a surface with its orientation reversed: triangles turned, normals to the other side.
template <int dimension, class Element>
void append_reversed(Surface<dimension, Element>& to, const Surface<dimension, Element>& from) {
    const auto first_vertex = static_cast<std::uint32_t>(to.vertices.size());
    const auto first_element = static_cast<std::uint32_t>(to.elements.size());
    const auto append = [](auto& a, const auto& b) { a.insert(a.end(), b.begin(), b.end()); };
    append(to.vertices, from.vertices);
    append(to.attributes, from.attributes);
    append(to.elements, from.elements);
    append(to.shape_of, from.shape_of);
    append(to.level_of, from.level_of);
    for (const Point& n : from.normals) to.normals.push_back(-1.0 * n);
    for (auto simplex : from.simplices) {
        std::swap(simplex[0], simplex[1]);
        for (auto& v : simplex) v += first_vertex;
        to.simplices.push_back(simplex);
    }
    for (const std::uint32_t e : from.element_of) to.element_of.push_back(e + first_element);
    constexpr auto corners = static_cast<std::size_t>(dimension);
    for (std::size_t i = 0; i < from.reference.size(); ++i) {
        const std::size_t corner = i % corners;
        to.reference.push_back(from.reference[corner == 0 ? i + 1 : corner == 1 ? i - 1 : i]);
    }
    for (auto ridge : from.boundary) {
        std::ranges::reverse(ridge);
        for (auto& v : ridge) v += first_vertex;
        to.boundary.push_back(ridge);
    }
}

/// The surface around low <= U < high inside the domain, in one traversal. Where both level sets
/// keep away from the boundary of the domain it is closed, and encloses volume_between().
/// \return counts and the larger error bound of the two level sets
/// \throw InvalidInput unless low < high, and for options.cap: caps of bands are not made
/// \throw GridError as extract_isosurfaces()
template <class Grid, class Field, Criterion S, class Indicator, Executor E = SequentialExecutor>
Isosurface<Grid::dimension, ElementOf<Grid>> isoband(const Grid& grid, const Field& field,
                                                     double low, double high, const S& criterion,
                                                     const Indicator& indicator,
                                                     const IsosurfaceOptions& options = {},
                                                     const E& executor = {}) {
    if (!(low < high)) throw InvalidInput("the lower isovalue is not below the upper one");
    if (options.cap) throw InvalidInput("a band between two isovalues cannot be capped");
    const std::array<double, 2> isovalues{low, high};
    auto levels = isosurfaces(grid, field, std::span<const double>(isovalues), criterion, indicator,
                              options, executor);
    auto& band = levels[0];
    append_reversed(band.surface, levels[1].surface);
    band.counts.extracted += levels[1].counts.extracted;
    band.error_bound = std::max(band.error_bound, levels[1].error_bound);
    return std::move(band);
}

}  // namespace nestgrid
