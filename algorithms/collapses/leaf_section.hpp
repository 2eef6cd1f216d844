// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a triangle meets of one leaf whose map is affine: a polygon, found in the reference
// coordinates of the leaf.
#pragma once

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

/// The map of a leaf from positions to reference coordinates, and its faces.
class AffineLeaf {
public:
    /// \param corners of a tetrahedron, or of a prism or hexahedron whose map is affine
    AffineLeaf(Shape shape, std::span<const Point> corners);

    Point reference(const Point& x) const {
        const Point d = x - origin_;
        return {dot(row_[0], d), dot(row_[1], d), dot(row_[2], d)};
    }
    /// The distance from a face in reference coordinates; not negative inside the leaf.
    double from_face(std::size_t face, const Point& s) const;
    /// The direction of a face, not of unit length.
    Point face_direction(std::size_t face) const;

private:
    Shape shape_;
    Point origin_;
    std::array<Point, 3> row_;
};

/// The part of a triangle that lies in a leaf, in parts of the triangle's corners.
struct LeafSection {
    using Corner = std::array<double, 3>;  // adds up to 1

    std::array<Corner, 12> corner;
    std::size_t count = 0;
    /// The part of the triangle's area; half of it where it lies in a face between two leaves.
    double area = 0;
    bool leaves_domain = false;      ///< the triangle passes through a face on the boundary
    std::array<Point, 3> reference;  ///< of the triangle's corners

    Point at(std::size_t i) const {
        const auto& [a, b, c] = corner[i];
        return a * reference[0] + b * reference[1] + c * reference[2];
    }
};

/// \param boundary faces of the leaf on the boundary of the domain, one bit each
LeafSection cut_out(const AffineLeaf& leaf, Shape shape, unsigned boundary, const Triangle& x);

}  // namespace nestgrid::engine
