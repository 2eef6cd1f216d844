// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/affine_leaf.hpp>

#include <cmath>

namespace nestgrid::engine {

AffineLeaf::AffineLeaf(Shape shape, std::span<const Point> corners) : origin_{corners[0]} {
    const Point a = corners[1] - origin_;
    const Point b = corners[2] - origin_;
    const auto across = [&] {  // about as long as the leaf is wide
        const Point normal = cross(a, b);
        return (1 / std::sqrt(norm(normal))) * normal;
    };
    const std::size_t up = shape == Shape::hexahedron ? 4 : 3;
    const Point c = topology(shape).dimension == 2 ? across() : corners[up] - origin_;
    row_ = {cross(b, c), cross(c, a), cross(a, b)};
    const double inverse = 1 / dot(a, row_[0]);
    for (Point& row : row_) row = inverse * row;
}

Point AffineLeaf::face_direction(Shape shape, std::size_t face) const {
    const double at_origin = face_distances(shape, {0, 0, 0})[face];
    const double x = face_distances(shape, {1, 0, 0})[face] - at_origin;
    const double y = face_distances(shape, {0, 1, 0})[face] - at_origin;
    const double z = face_distances(shape, {0, 0, 1})[face] - at_origin;
    return x * row_[0] + y * row_[1] + z * row_[2];
}

}  // namespace nestgrid::engine
