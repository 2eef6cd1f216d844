// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// The affine map of a tetrahedron, prism or hexahedron from positions to reference coordinates,
/// and distances from its faces in these. In a triangle or quadrilateral the third coordinate is
/// the distance from its plane, in units of its width.
class AffineLeaf {
public:
    AffineLeaf(Shape shape, std::span<const Point> corners);

    Point reference(const Point& x) const {
        const Point d = x - origin_;
        return {dot(row_[0], d), dot(row_[1], d), dot(row_[2], d)};
    }
    /// The direction of a face into the leaf, not of unit length.
    Point face_direction(Shape shape, std::size_t face) const;

private:
    Point origin_;
    std::array<Point, 3> row_;
};

/// The distances of a point from all faces in reference coordinates: not negative inside. Numbered
/// as in Topology.
inline std::array<double, max_faces> face_distances(Shape shape, const Point& s) {
    const auto [x, y, z] = s;
    if (shape == Shape::tetrahedron) return {1 - x - y - z, x, y, z};
    if (shape == Shape::prism) return {z, 1 - z, y, 1 - x - y, x};
    if (shape == Shape::triangle) return {1 - x - y, x, y};
    return {x, 1 - x, y, 1 - y, z, 1 - z};
}

}  // namespace nestgrid::engine
