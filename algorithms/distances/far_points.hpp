// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <distances/closest_points.hpp>
#include <nestgrid/algorithms/executor.hpp>

namespace nestgrid::engine {

/// Looks for points of triangles that are farther than a distance from a surface. Triangles that
/// follow each other in space are looked at faster.
class FarSearch {
public:
    /// \param to borrowed
    FarSearch(const ClosestPoints& to, double distance) : to_{&to}, distance_{distance} {}

    /// A point that is farther, if there is one. Where there is none, no point of the triangle is.
    /// One that comes within a thousandth of the distance may be told although it keeps it.
    std::optional<Point> far_point(const Triangle& whole);
    bool is_near(const Point& x) { return to_->is_within(x, distance_, near_); }

private:
    const ClosestPoints* to_;
    double distance_;
    std::uint32_t near_ = 0;  // the triangle that was near last
    std::vector<Triangle> parts_;
};

/// The four congruent parts of a triangle, that in the middle first.
std::array<Triangle, 4> quarters(const Triangle& whole);

/// A point of each triangle of a surface that is not within a distance of another surface as a
/// whole. Where there is none, no point of the surface is farther than that; see
/// FarSearch::far_point().
std::vector<Point> far_points(const Surface<3>& from, const ClosestPoints& to, double distance,
                              const Executor& executor);

}  // namespace nestgrid::engine
