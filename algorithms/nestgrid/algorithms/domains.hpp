// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Domains of lenses (paper, section 4.3): functions that say how far a point is from a set.
//
// Invariants, for every function d here:
//   - |d(x) - d(y)| <= |x - y|: the Lipschitz constant is 1;
//   - d is 0 in the domain and positive outside.
// Consequence: d is at most the distance from the domain, and a lens needs no more; where a bound
// is cheaper than the distance, d is the bound. Your own function may also be negative inside, as
// signed distances are. Functions are called by several threads at once. The greatest of several
// such functions is one for the intersection of their domains, the least one for the union.
#pragma once

#include <functional>
#include <vector>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid {

/// The distance of a point from a domain: 0 inside.
using Distance = std::function<double(const Point&)>;
/// A distance from what both domains have in common, never above the true one.
Distance intersection(Distance a, Distance b);
/// The distance from the nearer of two domains.
Distance union_of(Distance a, Distance b);

/// The distance from a ball.
struct Ball {
    Point centre{};
    double radius = 0;
    double operator()(const Point& x) const;
};

/// The distance from a box with sides along the axes.
struct Box {
    Point low{};
    Point high{};
    double operator()(const Point& x) const;
};

/// The points x with dot(normal, x - through) <= 0.
class HalfSpace {
public:
    /// \param normal of any length; it points out of the domain
    /// \throw InvalidInput where the normal is zero, or a number is not finite
    HalfSpace(const Point& through, const Point& normal);
    /// Negative inside.
    double signed_distance(const Point& x) const { return dot(normal_, x) - offset_; }
    double operator()(const Point& x) const;

private:
    Point normal_;  // of length 1
    double offset_;
};

/// An intersection of half-spaces. The greatest distance from one of them is at most the distance
/// from the polyhedron.
class ConvexPolyhedron {
public:
    /// \throw InvalidInput where there is no half-space
    explicit ConvexPolyhedron(std::vector<HalfSpace> sides);
    double operator()(const Point& x) const;

private:
    std::vector<HalfSpace> sides_;
};

/// An infinite circular cone: what an eye sees through a disc.
class Cone {
public:
    /// \param towards the direction of the axis, of any length
    /// \param angle between the axis and the cone, in radians
    /// \throw InvalidInput where the direction is zero, a number is not finite, or the angle is not
    ///        between 0 and pi / 2
    Cone(const Point& apex, const Point& towards, double angle);
    double operator()(const Point& x) const;

private:
    Point apex_;
    Point axis_;
    double cos_;
    double sin_;
};

/// A point of an image.
using ImagePoint = std::array<double, 2>;

/// The inside, by the even-odd rule, of a polygon in the plane of the first two coordinates; in
/// space, the column above and below it.
class Polygon {
public:
    /// \param corners in order; the last one is joined to the first
    /// \throw InvalidInput where there are fewer than three corners, or a number is not finite
    explicit Polygon(std::vector<ImagePoint> corners);
    double operator()(const Point& x) const;
    const std::vector<ImagePoint>& corners() const { return corners_; }

private:
    bool contains(const ImagePoint& x) const;
    std::vector<ImagePoint> corners_;
};

/// A parallel view: the image of x is (dot(across, x) + offset[0], dot(up, x) + offset[1]).
struct AffineCamera {
    Point across{1, 0, 0};
    Point up{0, 1, 0};
    ImagePoint offset{0, 0};
};

/// The points that a parallel view shows in a domain of its image. Their distance is that in the
/// image, divided by the greatest factor by which the camera stretches lengths.
/// \param domain a distance in the image, a function of (u, v, 0)
/// \throw InvalidInput where the camera maps all points to one
Distance seen_in(const AffineCamera& camera, Distance domain);

/// A perspective view. The image of x is (u, v), both between -1 and 1 for what is seen.
struct PerspectiveCamera {
    Point eye{0, 0, 1};
    Point towards{0, 0, -1};  ///< of any length
    Point up{0, 1, 0};        ///< of any length, not parallel to `towards`
    double angle = 0.5;       ///< between the lower and the upper side of the view, in radians
    double aspect = 1;        ///< width / height
};

/// The points that a perspective view shows between two distances from the eye along `towards`.
/// \throw InvalidInput where the camera makes no sense, or not 0 <= nearest < farthest
ConvexPolyhedron view_frustum(const PerspectiveCamera& camera, double nearest, double farthest);
/// The points that a perspective view shows in a convex polygon of its image, between planes
/// through the eye.
/// \throw InvalidInput where the polygon is not convex, or the camera makes no sense
ConvexPolyhedron seen_in(const PerspectiveCamera& camera, const Polygon& polygon);

}  // namespace nestgrid
