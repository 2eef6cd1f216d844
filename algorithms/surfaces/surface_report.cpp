// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>

#include <surfaces/triangle_sides.hpp>

namespace nestgrid {

namespace {

using engine::for_each_edge;
using engine::OrientedSide;
using Sides = std::vector<OrientedSide>;

/// \throw InvalidInput where a triangle repeats a vertex or names one that does not exist
void require_triangles(const Surface<3>& surface) {
    for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& v = surface.simplices[t];
        for (std::size_t i = 0; i < 3; ++i) {
            if (v[i] >= surface.vertices.size() || v[i] == v[(i + 1) % 3]) {
                throw InvalidInput("triangle " + std::to_string(t) +
                                   " repeats a vertex or names one that does not exist");
            }
        }
    }
}

void count_edges(const Sides& sides, const Surface<3>& surface, SurfaceReport& report) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary;
    for (const auto& edge : surface.boundary) boundary.emplace_back(std::minmax(edge[0], edge[1]));
    std::sort(boundary.begin(), boundary.end());
    for_each_edge(sides, [&](std::span<const OrientedSide> edge) {
        ++report.edges;
        if (edge.size() == 1) {
            const bool known = std::binary_search(boundary.begin(), boundary.end(), edge[0].ends());
            ++(known ? report.boundary_edges : report.open_edges);
        } else if (edge.size() > 2) {
            ++report.nonmanifold_edges;
        } else if (edge[0].forward == edge[1].forward) {
            ++report.misoriented_edges;
        }
    });
}

/// The number of a triangle's corner at a vertex, among all corners.
std::uint32_t corner_at(const Surface<3>& surface, std::uint32_t triangle, std::uint32_t vertex) {
    const auto& v = surface.simplices[triangle];
    return 3 * triangle + (v[0] == vertex ? 0U : v[1] == vertex ? 1U : 2U);
}

/// Counts the vertices whose triangles do not form one fan. Corners are joined where their
/// triangles share a side, so that each class is a fan.
std::size_t count_nonmanifold_vertices(const Surface<3>& surface, const Sides& sides) {
    detail::UnionFind fans(3 * surface.simplices.size());
    for_each_edge(sides, [&](std::span<const OrientedSide> edge) {
        for (const OrientedSide& side : edge.subspan(1)) {
            for (const std::uint32_t v : {side.low, side.high}) {
                fans.join(corner_at(surface, edge[0].triangle, v),
                          corner_at(surface, side.triangle, v));
            }
        }
    });
    constexpr std::uint32_t none = 0xFFFFFFFFU;
    std::vector<std::uint32_t> fan_of(surface.vertices.size(), none);
    std::vector<bool> bad(surface.vertices.size(), false);
    for (std::uint32_t c = 0; c < 3 * surface.simplices.size(); ++c) {
        const std::uint32_t v = surface.simplices[c / 3][c % 3];
        const std::uint32_t fan = fans.root(c);
        if (fan_of[v] == none) fan_of[v] = fan;
        if (fan_of[v] != fan) bad[v] = true;
    }
    return static_cast<std::size_t>(std::count(bad.begin(), bad.end(), true));
}

/// Counts the vertices that belong to a triangle, and the components that edges make of them.
void count_vertices(const Surface<3>& surface, SurfaceReport& report) {
    detail::UnionFind components(surface.vertices.size());
    std::vector<bool> used(surface.vertices.size(), false);
    for (const auto& t : surface.simplices) {
        for (const std::uint32_t v : t) used[v] = true;
        components.join(t[0], t[1]);
        components.join(t[0], t[2]);
    }
    for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
        if (!used[v]) continue;
        ++report.vertices;
        if (components.root(v) == v) ++report.components;
    }
}

/// Whether the corners of a triangle are on a line, or at one place, up to the rounding of their
/// positions.
/// \param corner relative to the origin
bool is_degenerate(const Point& origin, const std::array<Point, 3>& corner, double doubled_area) {
    double longest = 0;
    double greatest = 0;  // of the coordinates
    for (std::size_t i = 0; i < 3; ++i) {
        longest = std::max(longest, norm(corner[i] - corner[(i + 1) % 3]));
        for (std::size_t d = 0; d < 3; ++d) {
            greatest = std::max(greatest, std::abs(corner[i][d] + origin[d]));
        }
    }
    return doubled_area <= 4 * std::numeric_limits<double>::epsilon() * greatest * longest;
}

/// Fills in the areas and the degenerate triangles, and returns the volume.
double measure(const Surface<3>& surface, SurfaceReport& report) {
    const bool has_normals = surface.normals.size() == surface.vertices.size();
    const Point origin = surface.vertices.empty() ? Point{} : surface.vertices.front();
    double volume = 0;
    for (const auto& t : surface.simplices) {
        const Point a = surface.vertices[t[0]] - origin;
        const Point b = surface.vertices[t[1]] - origin;
        const Point c = surface.vertices[t[2]] - origin;
        const Point n = cross(b - a, c - a);
        const double area = norm(n) / 2;
        if (is_degenerate(origin, {a, b, c}, 2 * area)) ++report.degenerate_triangles;
        report.area += area;
        for (const std::uint32_t v : t) {
            const bool behind = has_normals && dot(surface.normals[v], n) < 0;
            report.area_behind += behind ? area / 3 : 0;
        }
        volume += dot(a, cross(b, c)) / 6;
    }
    return volume;
}

}  // namespace

SurfaceReport surface_report(const Surface<3>& surface) {
    SurfaceReport report;
    report.triangles = surface.simplices.size();
    require_triangles(surface);
    const Sides sides = engine::sorted_sides(surface.simplices);
    count_edges(sides, surface, report);
    count_vertices(surface, report);
    report.nonmanifold_vertices = count_nonmanifold_vertices(surface, sides);
    report.euler = static_cast<long long>(report.vertices) - static_cast<long long>(report.edges) +
                   static_cast<long long>(report.triangles);
    const double volume = measure(surface, report);
    if (report.closed()) report.volume = volume;
    return report;
}

}  // namespace nestgrid
