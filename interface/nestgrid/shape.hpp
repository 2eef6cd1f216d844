// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Element shapes: tensor products of simplices (paper, section 1.2), and the pyramid, which occurs
// in the closures of real grids.
//
// Invariants:
//   - corners are numbered as in a tensor product, the first factor running fastest: the corners
//     of a quadrilateral are 00, 10, 01, 11, those of a prism the triangle below, then above;
//   - the corners of a face are listed in a loop, counterclockwise seen from outside a positively
//     oriented element; the faces of a two-dimensional shape are its edges, counterclockwise;
//   - face i of a simplex lies opposite to corner i.
// Consequence: a walk around the faces gives volumes and orientations of every shape alike.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/detail/same_library.hpp>

namespace nestgrid {

/// The shapes of elements.
enum class Shape : std::uint8_t {
    point,
    segment,
    triangle,
    quadrilateral,
    tetrahedron,
    pyramid,  ///< base 0..3 as a quadrilateral, apex 4; its interpolant is the rational one that
              ///< is bilinear on the base and linear on the triangles (Bedrosian 1992)
    prism,
    hexahedron,
};

inline constexpr int max_corners = 8;
inline constexpr int max_edges = 12;
inline constexpr int max_faces = 6;
inline constexpr int shape_count = 8;

/// A face of a shape.
struct FaceTopology {
    Shape shape = Shape::point;
    std::uint8_t corners = 0;
    std::array<std::uint8_t, 4> corner{};  ///< loop, counterclockwise from outside

    /// The corners in tensor order: a quadrilateral's loop 0 1 2 3 is 0 1 3 2 as a product.
    constexpr std::uint8_t tensor_corner(int i) const {
        return shape == Shape::quadrilateral && i >= 2 ? corner[static_cast<std::size_t>(5 - i)]
                                                       : corner[static_cast<std::size_t>(i)];
    }
};

/// The corners, edges and faces of a shape.
struct Topology {
    std::string_view name;
    std::uint8_t dimension = 0;
    std::uint8_t corners = 0;
    std::uint8_t edges = 0;
    std::uint8_t faces = 0;
    std::array<std::array<std::uint8_t, 2>, max_edges> edge{};
    std::array<FaceTopology, max_faces> face{};
    std::array<Point, max_corners> reference{};  ///< corners of the reference element
};

namespace detail {

constexpr FaceTopology point(std::uint8_t a) { return {Shape::point, 1, {a}}; }
constexpr FaceTopology segment(std::uint8_t a, std::uint8_t b) {
    return {Shape::segment, 2, {a, b}};
}
constexpr FaceTopology triangle(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
    return {Shape::triangle, 3, {a, b, c}};
}
constexpr FaceTopology quad(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
    return {Shape::quadrilateral, 4, {a, b, c, d}};
}

inline constexpr Point o000{0, 0, 0}, o100{1, 0, 0}, o010{0, 1, 0}, o110{1, 1, 0};
inline constexpr Point o001{0, 0, 1}, o101{1, 0, 1}, o011{0, 1, 1}, o111{1, 1, 1};

inline constexpr std::array<Topology, shape_count> topologies{{
    {"point", 0, 1, 0, 0, {}, {}, {o000}},
    {"segment", 1, 2, 1, 2, {{{0, 1}}}, {{point(0), point(1)}}, {o000, o100}},
    {"triangle",
     2,
     3,
     3,
     3,
     {{{1, 2}, {2, 0}, {0, 1}}},
     {{segment(1, 2), segment(2, 0), segment(0, 1)}},
     {o000, o100, o010}},
    {"quadrilateral",
     2,
     4,
     4,
     4,
     {{{0, 2}, {1, 3}, {0, 1}, {2, 3}}},
     {{segment(2, 0), segment(1, 3), segment(0, 1), segment(3, 2)}},
     {o000, o100, o010, o110}},
    {"tetrahedron",
     3,
     4,
     6,
     4,
     {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}},
     {{triangle(1, 2, 3), triangle(0, 3, 2), triangle(0, 1, 3), triangle(0, 2, 1)}},
     {o000, o100, o010, o001}},
    {"pyramid",
     3,
     5,
     8,
     5,
     {{{0, 1}, {0, 2}, {1, 3}, {2, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
     {{quad(0, 2, 3, 1), triangle(0, 1, 4), triangle(1, 3, 4), triangle(3, 2, 4),
       triangle(2, 0, 4)}},
     {o000, o100, o010, o110, o001}},
    {"prism",
     3,
     6,
     9,
     5,
     {{{0, 1}, {0, 2}, {1, 2}, {3, 4}, {3, 5}, {4, 5}, {0, 3}, {1, 4}, {2, 5}}},
     {{triangle(0, 2, 1), triangle(3, 4, 5), quad(0, 1, 4, 3), quad(1, 2, 5, 4), quad(0, 3, 5, 2)}},
     {o000, o100, o010, o001, o101, o011}},
    {"hexahedron",
     3,
     8,
     12,
     6,
     {{{0, 1},
       {2, 3},
       {4, 5},
       {6, 7},
       {0, 2},
       {1, 3},
       {4, 6},
       {5, 7},
       {0, 4},
       {1, 5},
       {2, 6},
       {3, 7}}},
     {{quad(0, 4, 6, 2), quad(1, 3, 7, 5), quad(0, 1, 5, 4), quad(2, 6, 7, 3), quad(0, 2, 3, 1),
       quad(4, 5, 7, 6)}},
     {o000, o100, o010, o110, o001, o101, o011, o111}},
}};

/// Six times the volume of the cone from the origin over a face: exact for the bilinear patch
/// through the corners of a quadrilateral, so that two elements sharing a face agree.
constexpr double cone(const FaceTopology& face, std::span<const Point> x) {
    const auto cone3 = [&](int a, int b, int c) {
        const auto at = [&](int i) { return x[face.corner[static_cast<std::size_t>(i)]]; };
        return dot(at(a), cross(at(b), at(c)));
    };
    if (face.corners == 3) return cone3(0, 1, 2);
    return 0.5 * (cone3(0, 1, 2) + cone3(0, 2, 3) + cone3(0, 1, 3) + cone3(1, 2, 3));
}

}  // namespace detail

/// The corners, edges and faces of a shape, numbered as above.
constexpr const Topology& topology(Shape shape) {
    return detail::topologies[static_cast<std::size_t>(shape)];
}

namespace detail {

inline constexpr auto edge_numbers = [] {
    std::array<std::array<std::array<std::uint8_t, max_corners>, max_corners>, shape_count>
        number{};
    for (std::size_t s = 0; s < shape_count; ++s) {
        for (std::uint8_t e = 0; e < topologies[s].edges; ++e) {
            const auto [a, b] = topologies[s].edge[e];
            number[s][a][b] = number[s][b][a] = e;
        }
    }
    return number;
}();

}  // namespace detail

/// The number of the edge between two corners that there is one between.
constexpr std::uint8_t edge_between(Shape shape, std::size_t a, std::size_t b) {
    return detail::edge_numbers[static_cast<std::size_t>(shape)][a][b];
}

/// Whether a shape is a point, segment, triangle or tetrahedron.
constexpr bool is_simplex(Shape shape) {
    return topology(shape).corners == topology(shape).dimension + 1;
}

/// Volume, area vector or length vector of an element. In three dimensions the signed volume is
/// returned in the last coordinate, in two the vector area, in one the difference of the ends.
constexpr Point measure_vector(Shape shape, std::span<const Point> x) {
    const Topology& t = topology(shape);
    if (t.dimension == 1) return x[1] - x[0];
    Point result{0, 0, 0};
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        if (t.dimension == 2) {
            result = result + 0.5 * cross(x[face.corner[0]] - x[0], x[face.corner[1]] - x[0]);
        } else {
            std::array<Point, max_corners> local{};
            for (std::size_t i = 0; i < t.corners; ++i) local[i] = x[i] - x[0];
            result[2] += detail::cone(face, local) / 6;
        }
    }
    return result;
}

/// Signed volume in three dimensions; area and length, without a sign, in two and one.
inline double measure(Shape shape, std::span<const Point> x) {
    const Point v = measure_vector(shape, x);
    return topology(shape).dimension == 3 ? v[2] : norm(v);
}

}  // namespace nestgrid
