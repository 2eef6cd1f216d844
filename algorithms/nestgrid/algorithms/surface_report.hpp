// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <tuple>
#include <utility>

#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/connected_components.hpp>

#include <nestgrid/algorithms/surface.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

/// What there is to know about a triangle surface. Everything is counted from the indices alone;
/// vertices are never compared by position.
struct SurfaceReport {
    std::size_t vertices = 0;  ///< that belong to a triangle
    std::size_t edges = 0;
    std::size_t triangles = 0;
    std::size_t open_edges = 0;            ///< of one triangle only, inside the domain: cracks
    std::size_t boundary_edges = 0;        ///< of one triangle only, on the boundary of the domain
    std::size_t nonmanifold_edges = 0;     ///< of more than two triangles
    std::size_t misoriented_edges = 0;     ///< of two triangles that disagree about the outside
    std::size_t nonmanifold_vertices = 0;  ///< whose triangles do not form one fan
    std::size_t degenerate_triangles = 0;  ///< without area in double precision
    std::size_t components = 0;
    long long euler = 0;  ///< vertices - edges + triangles
    double area = 0;
    double volume = 0;  ///< enclosed, positive for U >= C inside; 0 unless closed

    /// No edge belongs to one triangle only.
    bool closed() const { return open_edges == 0 && boundary_edges == 0; }
    bool manifold() const {
        return nonmanifold_edges == 0 && nonmanifold_vertices == 0 && misoriented_edges == 0;
    }
};

namespace detail {

/// One side of a triangle, ends ascending; `forward` where the triangle runs along it upwards.
struct Side {
    std::uint32_t low;
    std::uint32_t high;
    std::uint32_t triangle;
    bool forward;

    auto ends() const { return std::pair(low, high); }
};

template <class Element>
std::vector<Side> sorted_sides(const Surface<3, Element>& surface) {
    std::vector<Side> sides;
    sides.reserve(3 * surface.simplices.size());
    for (std::uint32_t t = 0; t < surface.simplices.size(); ++t) {
        const auto& v = surface.simplices[t];
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i];
            const std::uint32_t b = v[(i + 1) % 3];
            if (a >= surface.vertices.size() || a == b) {
                throw InvalidInput("triangle " + std::to_string(t) +
                                   " repeats a vertex or names one that does not exist");
            }
            sides.push_back({std::min(a, b), std::max(a, b), t, a < b});
        }
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return sides;
}

/// Corners of triangles, glued where two triangles share a side: one class per fan of a vertex.
class Fans {
public:
    explicit Fans(std::size_t corners) : parent_(corners) {
        for (std::size_t i = 0; i < corners; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void glue(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

private:
    std::vector<std::uint32_t> parent_;
};

template <class Element>
std::uint32_t corner_at(const Surface<3, Element>& surface, std::uint32_t triangle,
                        std::uint32_t vertex) {
    const auto& v = surface.simplices[triangle];
    return 3 * triangle + (v[0] == vertex ? 0U : v[1] == vertex ? 1U : 2U);
}

template <class Element>
std::size_t count_nonmanifold_vertices(const Surface<3, Element>& surface, Fans& fans) {
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

template <class Element>
std::size_t count_components(const Surface<3, Element>& surface, const std::vector<Side>& sides,
                             std::size_t used_vertices) {
    boost::adjacency_list<boost::vecS, boost::vecS, boost::undirectedS> graph(
        surface.vertices.size());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (i == 0 || sides[i].ends() != sides[i - 1].ends()) {
            boost::add_edge(sides[i].low, sides[i].high, graph);
        }
    }
    std::vector<std::size_t> component(surface.vertices.size());
    if (component.empty()) return 0;
    const auto all = static_cast<std::size_t>(boost::connected_components(graph, component.data()));
    return all - (surface.vertices.size() - used_vertices);  // unused vertices stand alone
}

}  // namespace detail

/// Counts and measures a triangle surface.
/// \throw InvalidInput where a triangle repeats a vertex or names one that does not exist
template <class Element>
SurfaceReport surface_report(const Surface<3, Element>& surface) {
    SurfaceReport report;
    report.triangles = surface.simplices.size();
    const std::vector<detail::Side> sides = detail::sorted_sides(surface);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary;
    for (const auto& edge : surface.boundary) boundary.push_back(std::minmax(edge[0], edge[1]));
    std::sort(boundary.begin(), boundary.end());

    detail::Fans fans(3 * surface.simplices.size());
    for (auto first = sides.begin(); first != sides.end();) {
        const auto last = std::find_if(
            first, sides.end(), [&](const detail::Side& s) { return s.ends() != first->ends(); });
        const auto count = last - first;
        ++report.edges;
        if (count == 1) {
            const bool known = std::binary_search(boundary.begin(), boundary.end(), first->ends());
            ++(known ? report.boundary_edges : report.open_edges);
        } else if (count > 2) {
            ++report.nonmanifold_edges;
        } else if (first->forward == (first + 1)->forward) {
            ++report.misoriented_edges;
        }
        for (auto side = first + 1; side != last; ++side) {
            for (const std::uint32_t v : {first->low, first->high}) {
                fans.glue(detail::corner_at(surface, first->triangle, v),
                          detail::corner_at(surface, side->triangle, v));
            }
        }
        first = last;
    }

    std::vector<bool> used(surface.vertices.size(), false);
    const Point origin = surface.vertices.empty() ? Point{} : surface.vertices.front();
    double volume = 0;
    for (const auto& t : surface.simplices) {
        for (const std::uint32_t v : t) used[v] = true;
        const Point a = surface.vertices[t[0]] - origin;
        const Point b = surface.vertices[t[1]] - origin;
        const Point c = surface.vertices[t[2]] - origin;
        const double area = norm(cross(b - a, c - a)) / 2;
        if (area == 0) ++report.degenerate_triangles;
        report.area += area;
        volume += dot(a, cross(b, c)) / 6;
    }
    report.vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
    report.nonmanifold_vertices = detail::count_nonmanifold_vertices(surface, fans);
    report.components = detail::count_components(surface, sides, report.vertices);
    report.euler = static_cast<long long>(report.vertices) - static_cast<long long>(report.edges) +
                   static_cast<long long>(report.triangles);
    if (report.closed()) report.volume = volume;
    return report;
}

}  // namespace nestgrid
