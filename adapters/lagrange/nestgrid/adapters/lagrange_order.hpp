// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// In which order VTK numbers the points of Lagrange cells: corners, inner nodes of edges, of faces,
// of the cell, the latter as those of a smaller cell. Included by lagrange_cells.hpp; tests compare
// all of it with VTK's own functions.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// A node (i, j, k) of the lattice of a cell.
using LatticePlace = std::array<int, 3>;

namespace detail {

constexpr bool is_box(Shape shape) {
    return shape == Shape::quadrilateral || shape == Shape::hexahedron;
}

/// How many nodes the lattice of a shape has.
constexpr std::size_t lattice_size(Shape shape, int degree) {
    const auto n = static_cast<std::size_t>(degree) + 1;
    const std::size_t square = n * n;
    switch (shape) {
        case Shape::triangle:
            return n * (n + 1) / 2;
        case Shape::quadrilateral:
            return square;
        case Shape::tetrahedron:
            return n * (n + 1) * (n + 2) / 6;
        case Shape::prism:
            return n * n * (n + 1) / 2;
        case Shape::pyramid:
            return n * (n + 1) * (2 * n + 1) / 6;
        case Shape::hexahedron:
            return square * n;
        default:
            return 0;
    }
}

/// A node among the points of a quadrilateral or hexahedron of degree p.
inline std::size_t box_point(const LatticePlace& at, int p, int dimension) {
    const auto inner = [&](int d) { return at[static_cast<std::size_t>(d)] % p != 0; };
    const auto high = [&](int d) { return at[static_cast<std::size_t>(d)] == p; };
    const int m = p - 1;  // inner nodes of an edge
    const auto loop = [](bool x, bool y) { return x ? (y ? 2 : 1) : (y ? 3 : 0); };
    const int inside = int{inner(0)} + int{inner(1)} + int{dimension == 3 && inner(2)};
    const int above = dimension == 3 && high(2) ? 1 : 0;
    const auto number = [&](int base, int i, int j = 0) {
        const int place = base + i + m * j;
        return static_cast<std::size_t>(place);
    };
    if (inside == 0) return number(loop(high(0), high(1)) + 4 * above, 0);
    const int edges = dimension == 3 ? 8 : 4;  // where their nodes begin
    if (inside == 1) {
        // Edges along x and y run around the lower face, then around the upper one.
        if (inner(0)) return number(edges + m * ((high(1) ? 2 : 0) + 4 * above), at[0] - 1);
        if (inner(1)) return number(edges + m * ((high(0) ? 1 : 3) + 4 * above), at[1] - 1);
        return number(edges + m * (8 + loop(high(0), high(1))), at[2] - 1);
    }
    const int faces = edges + m * (dimension == 3 ? 12 : 4);
    if (dimension == 2) return number(faces, at[0] - 1, at[1] - 1);
    if (inside == 3) return number(faces + 6 * m * m + m * m * (at[2] - 1), at[0] - 1, at[1] - 1);
    if (!inner(0)) return number(faces + m * m * int{high(0)}, at[1] - 1, at[2] - 1);
    if (!inner(1)) return number(faces + m * m * (2 + int{high(1)}), at[0] - 1, at[2] - 1);
    return number(faces + m * m * (4 + int{high(2)}), at[0] - 1, at[1] - 1);
}

/// A node with these barycentric coordinates, those of x, y and the first corner, of a triangle.
inline int triangle_point(std::array<int, 3> b, int p) {
    int before = 0;
    int least = 0;
    int most = p;
    for (; std::ranges::find(b, least) == b.end(); p -= 3) {  // in a triangle inside
        before += 3 * p;
        ++least;
        most -= 2;
    }
    if (b[2] == most) return before;
    if (b[0] == most) return before + 1;
    if (b[1] == most) return before + 2;
    const int inner = most - least - 1;  // nodes of an edge
    if (b[1] == least) return before + 3 + b[0] - least - 1;
    if (b[2] == least) return before + 3 + inner + b[1] - least - 1;
    return before + 3 + 2 * inner + b[2] - least - 1;
}

/// A node with these barycentric coordinates, those of x, y, z and the first corner, of a
/// tetrahedron.
inline int tetrahedron_point(std::array<int, 4> b, int p) {
    // Which coordinates are least on an edge, which one grows along it. Which are least on a face,
    // and which ones are the coordinates of its triangle.
    constexpr std::array<std::array<std::size_t, 3>, 6> edges{
        {{1, 2, 0}, {2, 3, 1}, {0, 2, 3}, {0, 1, 2}, {1, 3, 2}, {0, 3, 2}}};
    constexpr std::array<std::array<std::size_t, 4>, 4> faces{
        {{1, 0, 2, 3}, {3, 2, 0, 1}, {0, 2, 1, 3}, {2, 1, 0, 3}}};
    int before = 0;
    int least = 0;
    int most = p;
    for (; std::ranges::find(b, least) == b.end(); p -= 4) {  // in a tetrahedron inside
        before += 2 * (p * p + 1);
        ++least;
        most -= 3;
    }
    constexpr std::array<std::size_t, 4> corners{3, 0, 1, 2};
    for (int k = 0; k < 4; ++k) {
        if (b[corners[static_cast<std::size_t>(k)]] == most) return before + k;
    }
    before += 4;
    for (const auto& [first, second, along] : edges) {
        if (b[first] == least && b[second] == least) return before + b[along] - least - 1;
        before += most - least - 1;
    }
    for (const auto& [across, x, y, corner] : faces) {
        if (b[across] == least) {
            return before + triangle_point({b[x] - least, b[y] - least, b[corner] - least}, p) -
                   3 * p;
        }
        before += (p + 1) * (p + 2) / 2 - 3 * p;
    }
    return before;
}

/// A node of a prism of degree p.
inline int prism_point(const LatticePlace& at, int p) {
    const auto [i, j, k] = at;
    const int m = p - 1;  // inner nodes of an edge
    const bool left = i == 0;
    const bool front = j == 0;
    const bool slanted = i + j == p;
    const bool level = k == 0 || k == p;
    const int above = k == p ? 1 : 0;
    const int on = int{left} + int{front} + int{slanted} + int{level};
    const int upright = left && front ? 0 : front && slanted ? 1 : 2;
    if (on == 3) return upright + 3 * above;
    if (on == 2 && !level) return 6 + 6 * m + upright * m + k - 1;
    if (on == 2) {
        const int edge = 6 + 3 * m * above;
        if (front) return edge + i - 1;
        return slanted ? edge + m + j - 1 : edge + 2 * m + p - j - 1;
    }
    const int triangle = m * (m - 1) / 2;  // inner nodes of one
    const int in_triangle = i + p * (j - 1) - j * (j + 1) / 2;
    const int faces = 6 + 9 * m;
    if (on == 1 && level) return faces + triangle * above + in_triangle;
    const int squares = faces + 2 * triangle;
    if (on == 1) {
        if (front) return squares + i - 1 + m * (k - 1);
        if (slanted) return squares + m * m + p - i - 1 + m * (k - 1);
        return squares + 2 * m * m + p - j - 1 + m * (k - 1);
    }
    return squares + 3 * m * m + triangle * (k - 1) + in_triangle;
}

/// A node among the points of a cell of degree p.
inline std::size_t lattice_point(Shape shape, const LatticePlace& at, int p) {
    const auto [i, j, k] = at;
    switch (shape) {
        case Shape::triangle:
            return static_cast<std::size_t>(triangle_point({i, j, p - i - j}, p));
        case Shape::tetrahedron:
            return static_cast<std::size_t>(tetrahedron_point({i, j, k, p - i - j - k}, p));
        case Shape::prism:
            return static_cast<std::size_t>(prism_point(at, p));
        default:
            return box_point(at, p, topology(shape).dimension);
    }
}

/// All nodes of the lattice of a shape, i first.
inline std::vector<LatticePlace> lattice(Shape shape, int p) {
    const bool plane = topology(shape).dimension == 2;
    std::vector<LatticePlace> nodes;
    for (int k = 0; k <= (plane ? 0 : p); ++k) {
        const int most = shape == Shape::tetrahedron ? p - k : p;
        for (int j = 0; j <= most; ++j) {
            for (int i = 0; i <= (is_box(shape) ? p : most - j); ++i) nodes.push_back({i, j, k});
        }
    }
    return nodes;
}

/// Directions in which a node of degree 2 lies in the middle: the two nodes at the ends, of each.
inline std::vector<std::pair<LatticePlace, LatticePlace>> ends_around(Shape shape,
                                                                      const LatticePlace& at) {
    std::vector<std::pair<LatticePlace, LatticePlace>> ends;
    const auto add = [&](LatticePlace step) {
        std::pair<LatticePlace, LatticePlace> both{at, at};
        for (std::size_t d = 0; d < 3; ++d) {
            both.first[d] -= step[d];
            both.second[d] += step[d];
        }
        ends.push_back(both);
    };
    if (shape == Shape::prism) {  // in the middle of an edge of the triangle
        if (at[0] == 1 && at[1] == 0) add({1, 0, 0});
        if (at[0] == 0 && at[1] == 1) add({0, 1, 0});
        if (at[0] == 1 && at[1] == 1) add({1, -1, 0});
    } else {
        if (at[0] == 1) add({1, 0, 0});
        if (at[1] == 1) add({0, 1, 0});
    }
    if (at[2] == 1) add({0, 0, 1});
    return ends;
}

}  // namespace detail

}  // namespace nestgrid
