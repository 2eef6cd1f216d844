// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles in a leaf whose faces may be bent, or on which U is no polynomial.
#pragma once

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

/// Quadrilaterals, prisms and pyramids are hexahedra with corners that coincide, and U and the map
/// are trilinear on each. So both are within the hull of their values at the corners, on every box
/// of the reference hexahedron. A multiple of the distance from the triangle's plane may be taken
/// off: it is 0 on the triangle.
class DeformedLeaf {
public:
    /// \param corners, values of the leaf
    DeformedLeaf(const NearLeaf& leaf, std::span<const Point> corners,
                 const std::array<double, max_corners>& values);

    /// Whether |U - C| <= error where a triangle may meet the leaf, and the triangle keeps off the
    /// leaf's faces on the boundary of the domain.
    /// \param greatest raised to an upper bound of |U - C| there
    bool keeps(const FlatTriangle& triangle, double error, double& greatest) const {
        return keeps(whole_, triangle, error, most_halvings_, greatest);
    }

private:
    static constexpr int most_halvings_ = 4;

    struct Part {
        std::array<Point, 8> x;
        std::array<double, 8> value;
        unsigned boundary;  // faces of the hexahedron, one bit each
    };

    static double greatest_on(const Part& part, const FlatTriangle& triangle);
    static bool may_meet(const Part& part, const FlatTriangle& triangle);
    static bool keeps(const Part& part, const FlatTriangle& triangle, double error, int halvings,
                      double& greatest);
    static Part child(const Part& part, unsigned number);

    Part whole_;
};

}  // namespace nestgrid::engine
