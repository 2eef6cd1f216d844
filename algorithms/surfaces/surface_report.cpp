// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/surface_report.hpp>
#include <nestgrid/detail/union_find.hpp>
#include <nestgrid/error.hpp>
#include <surfaces/triangle_terms.hpp>

namespace nestgrid {

namespace {

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

/// The side of a triangle that a vertex sees: the triangle runs from the vertex to `next`, then to
/// `last`.
struct SeenSide {
    std::uint32_t next;
    std::uint32_t last;
};
using Link = std::span<const SeenSide>;

/// The sides that each vertex sees, one vertex after the other.
class Links {
public:
    explicit Links(const Surface<3>& surface) : first_(surface.vertices.size() + 1, 0) {
        for (const auto& t : surface.simplices) {
            for (const std::uint32_t v : t) ++first_[v + std::size_t{1}];
        }
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        sides_.resize(3 * surface.simplices.size());
        for (const auto& t : surface.simplices) {
            for (std::size_t i = 0; i < 3; ++i) {
                sides_[first_[t[i]]++] = {t[(i + 1) % 3], t[(i + 2) % 3]};
            }
        }
        // Each now tells where its vertex's sides end.
    }
    Link of(std::size_t vertex) const {
        const std::size_t begin = vertex == 0 ? 0 : first_[vertex - 1];
        return Link(sides_).subspan(begin, first_[vertex] - begin);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<SeenSide> sides_;
};

/// Whether the sides are one ring, each beginning where another ends: what most vertices see.
bool is_ring(Link link) {
    constexpr std::size_t most = 32;  // so that a vertex of many triangles does not take long
    if (link.size() > most) return false;
    std::uint32_t at = link[0].last;
    std::size_t steps = 1;
    for (; at != link[0].next && steps < link.size(); ++steps) {
        std::size_t i = 0;
        while (i < link.size() && link[i].next != at) ++i;
        if (i == link.size()) return false;
        at = link[i].last;
    }
    return at == link[0].next && steps == link.size();
}

/// Counts edges, vertices and what is wrong with them, from what the vertices see.
class LinkCounts {
public:
    LinkCounts(const Surface<3>& surface, SurfaceReport& report) : report_{report} {
        for (const auto& edge : surface.boundary) {
            boundary_.emplace_back(std::minmax(edge[0], edge[1]));
        }
        std::sort(boundary_.begin(), boundary_.end());
        const Links links(surface);
        for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
            const Link link = links.of(v);
            if (link.empty()) continue;
            ++report_.vertices;
            if (!is_ring(link)) {
                count_others(v, link);
                continue;
            }
            for (const SeenSide& side : link) report_.edges += side.next > v ? 1U : 0U;
        }
    }

private:
    /// An edge of a triangle at the vertex.
    struct Spoke {
        std::uint32_t end;   // the other vertex
        std::uint32_t side;  // of the triangle, in the link
        bool leaves;         // the triangle runs from the vertex to the other one
    };

    /// Counts the edges to vertices of higher numbers, and whether the triangles form one fan:
    /// those that share an edge are in one.
    void count_others(std::uint32_t vertex, Link link) {
        spokes_.clear();
        for (std::uint32_t i = 0; i < link.size(); ++i) {
            spokes_.push_back({link[i].next, i, true});
            spokes_.push_back({link[i].last, i, false});
        }
        std::ranges::stable_sort(spokes_, {}, &Spoke::end);
        detail::UnionFind fans(link.size());
        for (std::span<const Spoke> rest = spokes_; !rest.empty();) {
            std::size_t count = 1;
            while (count < rest.size() && rest[count].end == rest[0].end) {
                fans.join(rest[0].side, rest[count++].side);
            }
            if (rest[0].end > vertex) count_edge(vertex, rest.first(count));
            rest = rest.subspan(count);
        }
        std::size_t roots = 0;
        for (std::uint32_t i = 0; i < link.size(); ++i) roots += fans.root(i) == i ? 1U : 0U;
        if (roots > 1) ++report_.nonmanifold_vertices;
    }
    /// \param spokes those of the triangles on the edge from the vertex to one of a higher number
    void count_edge(std::uint32_t vertex, std::span<const Spoke> spokes) {
        ++report_.edges;
        if (spokes.size() == 1) {
            const bool known = std::binary_search(boundary_.begin(), boundary_.end(),
                                                  std::pair(vertex, spokes[0].end));
            ++(known ? report_.boundary_edges : report_.open_edges);
        } else if (spokes.size() > 2) {
            ++report_.nonmanifold_edges;
        } else if (spokes[0].leaves == spokes[1].leaves) {
            ++report_.misoriented_edges;
        }
    }

    SurfaceReport& report_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> boundary_;  // ends ascending, sorted
    std::vector<Spoke> spokes_;                                      // of the vertex at hand
};

/// Counts the components that edges make of the vertices.
std::size_t count_components(const Surface<3>& surface, std::size_t used) {
    detail::UnionFind components(surface.vertices.size());
    std::size_t joins = 0;
    for (const auto& t : surface.simplices) {
        for (std::size_t i = 1; i < 3; ++i) {
            const auto a = components.root(t[0]);
            const auto b = components.root(t[i]);
            if (a == b) continue;
            components.join(a, b);
            ++joins;
        }
    }
    return used - joins;
}

/// Whether a triangle is far from degenerate(), for lengths that neither overflow nor vanish.
/// \param limit 4 epsilon times the greatest coordinate of all vertices
bool is_clearly_wide(const std::array<Point, 3>& corner, const Point& n, double limit) {
    const Point a = corner[1] - corner[0];
    const Point b = corner[2] - corner[1];
    const Point c = corner[0] - corner[2];
    const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
    return dot(n, n) > 1.01 * limit * limit * longest;
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
    const Point origin = engine::origin_of(surface);
    double greatest = 0;
    for (const Point& x : surface.vertices) {
        for (const double coordinate : x) greatest = std::max(greatest, std::abs(coordinate));
    }
    const double limit = 4 * std::numeric_limits<double>::epsilon() * greatest;
    engine::ExactSum area;
    engine::ExactSum behind;
    engine::ExactSum volume;
    for (const auto& simplex : surface.simplices) {
        const auto t = engine::from_least_corner(surface, simplex);
        const engine::TriangleTerms terms(surface, t, origin);
        if (!is_clearly_wide(terms.corner, 2 * terms.normal, limit) &&
            is_degenerate(origin, terms.corner, 2 * terms.area)) {
            ++report.degenerate_triangles;
        }
        area.add(terms.area);
        volume.add(terms.volume);
        for (const std::uint32_t v : t) {
            const bool is_behind = has_normals && dot(surface.normals[v], terms.normal) < 0;
            if (is_behind) behind.add(terms.area / 3);
        }
    }
    report.area = area.value();
    report.area_behind = behind.value();
    return volume.value();
}

}  // namespace

SurfaceReport surface_report(const Surface<3>& surface) {
    SurfaceReport report;
    report.triangles = surface.simplices.size();
    require_triangles(surface);
    LinkCounts(surface, report);
    report.components = count_components(surface, report.vertices);
    report.euler = static_cast<long long>(report.vertices) - static_cast<long long>(report.edges) +
                   static_cast<long long>(report.triangles);
    const double volume = measure(surface, report);
    if (report.closed()) report.volume = volume;
    return report;
}

}  // namespace nestgrid
