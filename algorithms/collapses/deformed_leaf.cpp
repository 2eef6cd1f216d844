// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/deformed_leaf.hpp>

namespace nestgrid::engine {

namespace {

/// The corners of a hexahedron that is a shape, and the face of the shape that each of its faces
/// is.
struct AsHexahedron {
    std::array<std::uint8_t, 8> corner;
    std::array<int, 6> face;  // -1 where the face is an edge or a point
};

constexpr AsHexahedron quadrilateral{{0, 1, 2, 3, 0, 1, 2, 3}, {0, 1, 2, 3, -1, -1}};
constexpr AsHexahedron pyramid{{0, 1, 2, 3, 4, 4, 4, 4}, {4, 2, 1, 3, 0, -1}};
constexpr AsHexahedron prism{{0, 1, 2, 2, 3, 4, 5, 5}, {4, 3, 2, -1, 0, 1}};
constexpr AsHexahedron hexahedron{{0, 1, 2, 3, 4, 5, 6, 7}, {0, 1, 2, 3, 4, 5}};

const AsHexahedron& as_hexahedron(Shape shape) {
    if (shape == Shape::quadrilateral) return quadrilateral;
    if (shape == Shape::pyramid) return pyramid;
    return shape == Shape::prism ? prism : hexahedron;
}

}  // namespace

DeformedLeaf::DeformedLeaf(const NearLeaf& leaf, std::span<const Point> corners,
                           const std::array<double, max_corners>& values)
    : whole_{} {
    const AsHexahedron& as = as_hexahedron(leaf.shape);
    for (std::size_t i = 0; i < 8; ++i) {
        whole_.x[i] = corners[as.corner[i]];
        whole_.value[i] = values[as.corner[i]];
    }
    for (std::size_t f = 0; f < 6; ++f) {
        const int face = as.face[f];
        if (face >= 0 && (leaf.boundary >> face & 1U) != 0) whole_.boundary |= 1U << f;
    }
}

/// Looks for a plane between the hull of a part and the triangle: along the axes, that of the
/// triangle, and through each side.
bool DeformedLeaf::may_meet(const Part& part, const FlatTriangle& triangle) {
    if (!triangle.box.meets(Box::around(part.x))) return false;
    const auto all_beyond = [&](const Point& normal, const Point& at) {
        double least = Box::infinity;
        double greatest = -Box::infinity;
        for (const Point& x : part.x) {
            const double distance = dot(normal, x - at);
            least = std::min(least, distance);
            greatest = std::max(greatest, distance);
        }
        return std::array{least, greatest};
    };
    const auto [below, above] = all_beyond(triangle.normal, triangle.corner[0]);
    if (below > triangle.slack || above < -triangle.slack) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& a = triangle.corner[i];
        const Point outward = cross(triangle.corner[(i + 1) % 3] - a, triangle.normal);
        if (all_beyond(outward, a)[0] > 1e-12 * triangle.box.diameter() * norm(outward))
            return false;
    }
    return true;
}

/// One of the eight halves in all directions.
auto DeformedLeaf::child(const Part& part, unsigned number) -> Part {
    Part half = part;
    for (unsigned d = 0; d < 3; ++d) {
        const bool upper = (number >> d & 1U) != 0;
        half.boundary &= ~(1U << (2 * d + (upper ? 0U : 1U)));
        for (unsigned i = 0; i < 8; ++i) {
            if ((i >> d & 1U) != 0) continue;
            const unsigned j = i | 1U << d;
            const Point x = 0.5 * (half.x[i] + half.x[j]);
            const double value = 0.5 * (half.value[i] + half.value[j]);
            half.x[upper ? i : j] = x;
            half.value[upper ? i : j] = value;
        }
    }
    return half;
}

/// A bound of |U - C| on the triangle: the lesser one of those with and without the multiple of the
/// distance that fits best.
double DeformedLeaf::greatest_on(const Part& part, const FlatTriangle& triangle) {
    std::array<double, 8> distance{};
    double mean_distance = 0;
    double mean_value = 0;
    double most = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        distance[i] = dot(triangle.normal, part.x[i] - triangle.corner[0]);
        mean_distance += 0.125 * distance[i];
        mean_value += 0.125 * part.value[i];
        most = std::max(most, std::abs(part.value[i]));
    }
    double both = 0;
    double square = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        const double off = distance[i] - mean_distance;
        both += off * (part.value[i] - mean_value);
        square += off * off;
    }
    if (!(square > 0)) return most;
    double rest = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        rest = std::max(rest, std::abs(part.value[i] - both / square * distance[i]));
    }
    return std::min(most, rest);
}

bool DeformedLeaf::keeps(const Part& part, const FlatTriangle& triangle, double error, int halvings,
                         double& greatest) {
    if (!may_meet(part, triangle)) return true;
    const double most = greatest_on(part, triangle);
    if (most <= error && part.boundary == 0) {
        greatest = std::max(greatest, most);
        return true;
    }
    if (halvings == 0) return false;
    for (unsigned i = 0; i < 8; ++i) {
        if (!keeps(child(part, i), triangle, error, halvings - 1, greatest)) return false;
    }
    return true;
}

}  // namespace nestgrid::engine
