// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isoband.hpp>

#include <algorithm>
#include <array>

#include <nestgrid/error.hpp>
#include <projection/by_criterion.hpp>

namespace nestgrid {

namespace {

template <class Vector>
void append(Vector& to, const Vector& from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Appends a surface with its orientation reversed: triangles turned, normals to the other side.
template <int dimension>
void append_reversed(Surface<dimension>& to, const Surface<dimension>& from) {
    const auto first_vertex = static_cast<std::uint32_t>(to.vertices.size());
    const auto first_element = static_cast<std::uint32_t>(to.level_of.size());
    append(to.vertices, from.vertices);
    append(to.attributes, from.attributes);
    to.elements.append(from.elements);
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

}  // namespace

void engine::require_band(double low, double high, const IsosurfaceOptions& options) {
    if (!(low < high)) throw InvalidInput("the lower isovalue is not below the upper one");
    if (options.cap) throw InvalidInput("a band between two isovalues cannot be capped");
}

template <int dimension, class Real>
Isosurface<dimension> engine::isoband(const Hierarchy<Real>& hierarchy, double low, double high,
                                      const Criterion& criterion, const Bounds& bounds,
                                      const IsosurfaceOptions& options, const Executor& executor) {
    const std::array<double, 2> isovalues{low, high};
    auto levels = isosurfaces<dimension>(hierarchy, std::span<const double>(isovalues), {},
                                         criterion, bounds, options, executor);
    Isosurface<dimension>& band = levels[0];
    append_reversed(band.surface, levels[1].surface);
    // Both surfaces may have a vertex between the same nodes.
    for (const auto& [a, b] : levels[1].names) {
        band.names.push_back({nestgrid::detail::mix(a), nestgrid::detail::mix(b)});
    }
    band.counts.extracted += levels[1].counts.extracted;
    band.add_bounds(levels[1]);
    band.position_bound = std::max(band.position_bound, levels[1].position_bound);
    return std::move(band);
}

#define NESTGRID_INSTANTIATE(dimension, Real)                                    \
    template Isosurface<dimension> engine::isoband<dimension>(                   \
        const Hierarchy<Real>&, double, double, const Criterion&, const Bounds&, \
        const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
