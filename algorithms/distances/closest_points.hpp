// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of points from a surface, exact up to rounding.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <distances/box_tree.hpp>
#include <nestgrid/algorithms/surface.hpp>

namespace nestgrid::engine {

/// The square of the distance of a point from a triangle, which may be without area.
double square_distance(const Point& x, const Triangle& triangle);

/// Finds the triangles that are nearest to points. Several threads may ask at once.
class ClosestPoints {
public:
    /// \param surface borrowed
    explicit ClosestPoints(const Surface<3>& surface);

    static constexpr double infinity = std::numeric_limits<double>::infinity();

    /// A triangle and its distance; infinite where there is none.
    struct Nearest {
        double distance = infinity;
        std::uint32_t triangle = 0;
    };
    /// The triangle nearest to a point: of several, the first that is met.
    /// \param bound which its distance is known not to exceed: makes the search short
    Nearest nearest(const Point& x, double bound = infinity) const;
    /// The distance of a point from the surface; infinite where that is empty.
    double distance(const Point& x, double bound = infinity) const {
        return nearest(x, bound).distance;
    }
    /// Whether the distance of a point is at most a limit, which is not negative: faster than the
    /// distance.
    /// \param near a triangle that is looked at first, and afterwards one that is near enough; 0
    ///        for the first point
    bool is_within(const Point& x, double limit, std::uint32_t& near) const;
    /// Whether a triangle is within a limit of all points, and so of all between them.
    bool holds(std::uint32_t triangle, std::span<const Point> points, double limit) const;

private:
    Triangle triangle(std::uint32_t t) const {
        const auto& v = surface_->simplices[t];
        return {surface_->vertices[v[0]], surface_->vertices[v[1]], surface_->vertices[v[2]]};
    }

    const Surface<3>* surface_;
    std::vector<std::uint32_t> order_;  // triangles, near ones one after the other
    BoxTree tree_;                      // over them
};

}  // namespace nestgrid::engine
