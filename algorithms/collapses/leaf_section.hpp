// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The polygon that a triangle has in common with a leaf whose map is affine, found in the reference
// coordinates of the leaf.
#pragma once

#include <collapses/affine_leaf.hpp>
#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

class LeafSection {
public:
    /// A point of the triangle, in parts of its corners, which add up to 1.
    using Corner = std::array<double, 3>;

    /// Cuts a triangle. The same object may be used again and again.
    /// \return whether triangle and leaf have an area in common, or a line or a point. A triangle
    ///         across the plane of a leaf of dimension 2 has nothing in common with it
    bool cut(const NearLeaf& leaf, const AffineLeaf& map, const Triangle& x);

    std::span<const Corner> corners() const { return {corner_->data(), count_}; }
    /// The part of the triangle's area; half of it where it lies in a face between two leaves.
    double area() const;
    /// Whether the triangle passes through a face on the boundary of the domain.
    bool leaves_domain() const { return leaves_domain_; }
    /// The triangle's corners in reference coordinates.
    const std::array<Point, 3>& reference() const { return reference_; }

private:
    using Polygon = std::array<Corner, 3 + max_faces>;
    using Distances = std::array<double, 3>;  // of the triangle's corners from a face

    bool clip(const Distances& g);

    std::array<Polygon, 2> room_;
    Polygon* corner_ = room_.data();
    std::size_t count_ = 0;
    double part_ = 1;  // of the area that counts
    bool leaves_domain_ = false;
    std::array<Point, 3> reference_;
};

}  // namespace nestgrid::engine
