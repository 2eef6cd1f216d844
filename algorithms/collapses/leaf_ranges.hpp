// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Least and greatest values in groups of leaves, which spare looking at each leaf where colours
// keep within their errors of all values around.
#pragma once

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

/// A colour that is linear on a triangle, over boxes that the triangle meets.
struct LinearColour {
    double at_first;  ///< corner of the triangle
    Point slope;      ///< in the plane of the triangle
    double least;     ///< on the triangle
    double greatest;

    LinearColour(const FlatTriangle& triangle, const std::array<double, 3>& at_corners);
};

class LeafRanges {
public:
    /// Borrows the leaves.
    explicit LeafRanges(const NearLeaves& leaves);

    /// Whether colours by component keep within 1 of all values in the leaves of a group.
    /// \param first corner of the triangle
    bool keeps(std::size_t level, std::size_t group, const Box& box, const Point& first,
               std::span<const LinearColour> colours) const;

private:
    struct Range {
        double least = Box::infinity;
        double greatest = -Box::infinity;
    };

    std::size_t components_;
    std::vector<std::vector<Range>> levels_;  // by level of the tree, group and component
};

}  // namespace nestgrid::engine
