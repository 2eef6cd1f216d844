// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of the sign patterns of a simplex, generated from its topology (paper, section 8).
//
// Going around a face counterclockwise seen from outside, the contour on it runs from the edge
// where the sign falls to the edge where it rises. Every cut edge of an element falls on one of its
// two faces and rises on the other, so these segments link up to loops. A triangular face has at
// most one segment, so it is the same from both sides, reversed.
#pragma once

#include <vector>

#include <nestgrid/shape.hpp>

namespace nestgrid {

/// The contour of one sign pattern: cut edges in a loop; the segment from edge i to edge i + 1 lies
/// in face[i]. Seen along the loop, the corners with U >= C lie behind the polygon it spans.
struct Contour {
    std::uint8_t count = 0;
    std::array<std::uint8_t, 4> edge{};
    std::array<std::uint8_t, 4> face{};
};

namespace detail {

inline std::uint8_t edge_between(const Topology& t, std::uint8_t a, std::uint8_t b) {
    for (std::uint8_t e = 0; e < t.edges; ++e) {
        if ((t.edge[e][0] == a && t.edge[e][1] == b) || (t.edge[e][0] == b && t.edge[e][1] == a)) {
            return e;
        }
    }
    return 0;
}

/// Bit i of `pattern` says that corner i has U >= C.
inline Contour make_contour(Shape shape, unsigned pattern) {
    const Topology& t = topology(shape);
    Contour contour;
    const auto positive = [&](std::uint8_t corner) { return (pattern >> corner & 1U) != 0; };
    if (t.dimension == 2) {
        // The "loop" is one segment, from the falling edge to the rising one.
        for (std::uint8_t f = 0; f < t.faces; ++f) {
            const bool falls = positive(t.face[f].corner[0]) && !positive(t.face[f].corner[1]);
            const bool rises = !positive(t.face[f].corner[0]) && positive(t.face[f].corner[1]);
            if (!falls && !rises) continue;
            const std::uint8_t at = falls ? 0 : 1;
            contour.edge[at] = edge_between(t, t.face[f].corner[0], t.face[f].corner[1]);
            contour.face[at] = f;
            contour.count = 2;
        }
        return contour;
    }
    std::array<int, 12> next{};
    std::array<std::uint8_t, 12> face_of{};
    next.fill(-1);
    for (std::uint8_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        int falls = -1;
        int rises = -1;
        for (std::size_t i = 0; i < face.corners; ++i) {
            const std::uint8_t a = face.corner[i];
            const std::uint8_t b = face.corner[(i + 1U) % face.corners];
            if (positive(a) && !positive(b)) falls = edge_between(t, a, b);
            if (!positive(a) && positive(b)) rises = edge_between(t, a, b);
        }
        if (falls < 0) continue;
        next[static_cast<std::size_t>(rises)] = falls;
        face_of[static_cast<std::size_t>(rises)] = f;
    }
    for (std::size_t start = 0; start < next.size(); ++start) {
        if (next[start] < 0) continue;
        std::size_t e = start;
        do {
            contour.edge[contour.count] = static_cast<std::uint8_t>(e);
            contour.face[contour.count++] = face_of[e];
            e = static_cast<std::size_t>(next[e]);
        } while (e != start);
        break;  // a simplex has one loop
    }
    return contour;
}

}  // namespace detail

/// The contours of all sign patterns of a triangle or tetrahedron.
inline const std::array<Contour, 16>& contour_table(Shape simplex) {
    static const auto build = [](Shape shape) {
        std::array<Contour, 16> table;
        for (unsigned pattern = 0; pattern < 1U << topology(shape).corners; ++pattern) {
            table[pattern] = detail::make_contour(shape, pattern);
        }
        return table;
    };
    static const std::array<Contour, 16> triangle = build(Shape::triangle);
    static const std::array<Contour, 16> tetrahedron = build(Shape::tetrahedron);
    return simplex == Shape::triangle ? triangle : tetrahedron;
}

}  // namespace nestgrid
