// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Filling the loops of a contour with triangles.
//
// Every loop bounds a disc, or an annulus together with another one at the end of a tunnel.
// Invariants: each segment of a loop, or of the chain that replaces it, belongs to one triangle,
// which runs along it; every other edge belongs to two triangles, and joins no two vertices on one
// face.
#pragma once

#include <span>
#include <vector>

#include <contours/cell_contour.hpp>
#include <nestgrid/detail/inlining.hpp>

namespace nestgrid::engine {

/// Whether the diagonal from a to c is no longer than the one from b to d.
template <class P>
NESTGRID_INLINE bool shorter(const P& a, const P& c, const P& b, const P& d) {
    return dot(c - a, c - a) <= dot(d - b, d - b);
}

/// A Cell knows the vertices of one element under numbers of its own:
///     Number vertex(edge)                     on a cut edge
///     std::span<const Number> chain(edge)     what replaces the segment that follows this edge in
///                                             its loop: the vertices between, mostly none
///     bool chained()                          whether there is any chain
///     Point position(number)
///     Number middle(std::span<const Number>)  a new vertex in the middle of others
///     Number inside(reference point)          a new vertex
///     void triangle(a, b, c)
template <class Cell>
class ContourFilling {
public:
    using Number = std::uint32_t;
    using Chain = std::span<const Number>;

    explicit ContourFilling(Cell& cell) : cell_{&cell} {}

    void fill(const Contour& contour) {
        for (std::size_t i = 0; i < contour.loop_count; ++i) fill_disc(contour.loop[i]);
    }

    void fill(const Contour& contour, const Tunnel& tunnel) {
        for (std::size_t i = 0; i < contour.loop_count; ++i) {
            if (tunnel.from != i && tunnel.to != i) fill_disc(contour.loop[i]);
        }
        fill_annulus(contour.loop[tunnel.from], contour.loop[tunnel.to], tunnel);
    }

    /// Adds the triangle a b c with chains in the place of its sides. No new edge joins two
    /// vertices of one chain.
    void add(Number a, Number b, Number c, Chain ab = {}, Chain bc = {}, Chain ca = {}) {
        if (ab.empty() && !bc.empty()) {
            fill_chained(b, c, a, bc, ca, ab);
        } else if (ab.empty() && !ca.empty()) {
            fill_chained(c, a, b, ca, ab, bc);
        } else if (ab.empty()) {
            cell_->triangle(a, b, c);
        } else {
            fill_chained(a, b, c, ab, bc, ca);
        }
    }

private:
    using Vertices = std::array<Number, max_edges>;

    /// Adds the triangle a b c with a chain from a to b: a fan around c. Chains on the other sides
    /// make its first and its last triangle fans around the ends of the chain from a to b.
    void fill_chained(Number a, Number b, Number c, const Chain& ab, const Chain& bc,
                      const Chain& ca) {
        fill_fan(ab.front(), c, ca, a);
        for (std::size_t i = 1; i < ab.size(); ++i) cell_->triangle(ab[i - 1], ab[i], c);
        fill_fan(ab.back(), b, bc, c);
    }

    void fill_fan(Number around, Number from, const Chain& between, Number to) {
        for (const Number next : between) {
            cell_->triangle(from, next, around);
            from = next;
        }
        cell_->triangle(from, to, around);
    }

    Vertices vertices(const ContourLoop& loop) const {
        Vertices v;
        for (std::size_t i = 0; i < loop.count; ++i) v[i] = cell_->vertex(loop.edge[i]);
        return v;
    }

    double distance(Number a, Number b) const {
        return norm(cell_->position(a) - cell_->position(b));
    }

    void fill_disc(const ContourLoop& loop) {
        const Vertices v = vertices(loop);
        const std::size_t n = loop.count;
        const auto chain = [&](std::size_t i, std::size_t j) {
            return (i + 1) % n == j ? cell_->chain(loop.edge[i]) : Chain{};
        };
        const bool plain = !cell_->chained();
        const auto add_places = [&](std::size_t i, std::size_t j, std::size_t k) {
            if (plain) return cell_->triangle(v[i], v[j], v[k]);
            add(v[i], v[j], v[k], chain(i, j), chain(j, k), chain(k, i));
        };
        if (n == 3) return add_places(0, 1, 2);
        if (loop.any_diagonal) {  // the shorter one; both lie inside the element
            const auto x = [&](std::size_t i) { return cell_->position(v[i]); };
            const std::size_t a = shorter(x(0), x(2), x(1), x(3)) ? 0 : 1;
            add_places(a, a + 1, a + 2);
            add_places(a + 2, (a + 3) % 4, a);
            return;
        }
        for (std::size_t i = 0; i < loop.triangle_count; ++i) {
            add_places(loop.triangle[i][0], loop.triangle[i][1], loop.triangle[i][2]);
        }
        if (loop.triangle_count > 0) return;
        const Number centre = cell_->middle(std::span(v).first(n));
        for (std::size_t i = 0; i < n; ++i) {
            add(v[i], v[(i + 1) % n], centre, chain(i, (i + 1) % n));
        }
    }

    template <class Points>
    static Point area(const Points& x) {
        Point sum{0, 0, 0};
        for (std::size_t i = 1; i + 1 < x.size(); ++i) {
            sum = sum + cross(x[i] - x[0], x[i + 1] - x[0]);
        }
        return sum;
    }

    /// Fills the strip between a loop and a ring that runs the same way. Advances on both in step,
    /// because an edge would appear twice if one went around before the other began.
    void fill_strip(const ContourLoop& loop, const std::array<Number, 4>& ring) {
        const Vertices v = vertices(loop);
        const std::size_t n = loop.count;
        std::size_t start = 0;
        for (std::size_t j = 1; j < 4; ++j) {
            if (distance(v[0], ring[j]) < distance(v[0], ring[start])) start = j;
        }
        const auto at = [&](std::size_t j) { return ring[(start + j) % 4]; };
        for (std::size_t i = 0, j = 0; i < n || j < 4;) {
            const Number a = v[i % n];
            const Number next = v[(i + 1) % n];
            const bool along = 4 * i + 2 <= n * j + n / 2;
            if (along) {
                add(a, next, at(j), cell_->chain(loop.edge[i]));
                ++i;
            } else {
                add(a, at(j + 1), at(j));
                ++j;
            }
        }
    }

    /// Fills the annulus between two loops, through the ring around the neck of the tunnel.
    void fill_annulus(const ContourLoop& from, const ContourLoop& to, const Tunnel& tunnel) {
        std::array<Number, 4> ring;
        std::vector<Point> ring_points;
        std::vector<Point> loop_points;
        for (std::size_t j = 0; j < 4; ++j) {
            ring[j] = cell_->inside(tunnel.ring[j]);
            ring_points.push_back(cell_->position(ring[j]));
        }
        const Vertices v = vertices(from);
        for (std::size_t i = 0; i < from.count; ++i) loop_points.push_back(cell_->position(v[i]));
        if (dot(area(ring_points), area(loop_points)) < 0) std::reverse(ring.begin(), ring.end());
        fill_strip(from, ring);
        std::reverse(ring.begin(), ring.end());
        fill_strip(to, ring);
    }

    Cell* cell_;
};

}  // namespace nestgrid::engine
