// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices on the border of a surface may move on the planes of the domain's boundary on which they
// lie.
#pragma once

#include <collapses/near_leaves.hpp>

namespace nestgrid::engine {

struct BorderPlane {
    Point normal;  ///< of unit length
    double level;  ///< normal . x on the plane
    double slack;  ///< by which rounding may move points off it
};

/// The planes that a vertex must not leave; at most three.
class Freedom {
public:
    bool free() const { return count_ == 0; }
    /// Whether the vertex lies on every plane of another one that may move.
    bool keeps(const Freedom& other) const;
    std::size_t count() const { return count_; }
    /// Whether a plane of the boundary may be common to three vertices.
    static bool may_share_plane(const Freedom& a, const Freedom& b, const Freedom& c);
    /// Directions along all planes, of unit length and at right angles.
    /// \return how many
    std::size_t directions(std::array<Point, 3>& out) const;
    /// Adds a plane that is not among them yet.
    void add(const BorderPlane& plane);
    /// Fastens a vertex of which nothing is known.
    void fasten() { count_ = fast_; }

private:
    static constexpr std::size_t fast_ = 4;  // no way to move
    bool has_direction(const BorderPlane& plane) const;
    bool has(const BorderPlane& plane) const;

    std::size_t count_ = 0;
    std::array<BorderPlane, 3> plane_{};
};

/// The freedom of a vertex on an edge of one triangle only: that of the plane faces, on the
/// boundary of the domain, on which it lies. It is fastened where there are none, or bent ones.
Freedom border_freedom(const NearLeaves& leaves, const Point& x);

}  // namespace nestgrid::engine
