// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/domains.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

/// \throw InvalidInput where the vector has no direction
Point unit(const Point& v, const char* what) {
    const double length = norm(v);
    if (!(length > 0) || !std::isfinite(length)) {
        throw InvalidInput(std::string(what) + " is no direction: " + text_of(v));
    }
    return 1 / length * v;
}

void require_finite(const Point& x, const char* what) {
    if (!std::isfinite(x[0] + x[1] + x[2])) {
        throw InvalidInput(std::string(what) + " is no point: " + text_of(x));
    }
}

/// Twice the signed area of a triangle in an image.
double turn(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// The distance of a point from a segment.
double distance_from_segment(const ImagePoint& x, const ImagePoint& a, const ImagePoint& b) {
    const ImagePoint along{b[0] - a[0], b[1] - a[1]};
    const ImagePoint from{x[0] - a[0], x[1] - a[1]};
    const double square = along[0] * along[0] + along[1] * along[1];
    const double dot = along[0] * from[0] + along[1] * from[1];
    const double t = square > 0 ? std::clamp(dot / square, 0.0, 1.0) : 0.0;
    return std::hypot(from[0] - t * along[0], from[1] - t * along[1]);
}

/// The axes of a perspective view.
struct Eye {
    Point towards;
    Point right;  ///< to the right side of the view, at distance 1 from the eye
    Point up;     ///< to the upper side of the view, at distance 1 from the eye

    explicit Eye(const PerspectiveCamera& camera) {
        require_finite(camera.eye, "the eye");
        if (!(camera.angle > 0 && camera.angle < std::numbers::pi) || !(camera.aspect > 0) ||
            !std::isfinite(camera.aspect)) {
            throw InvalidInput(
                "a camera has an angle between 0 and pi and a positive aspect, not " +
                std::to_string(camera.angle) + " and " + std::to_string(camera.aspect));
        }
        towards = unit(camera.towards, "'towards'");
        const Point side = unit(cross(towards, camera.up), "the right side of the camera");
        const double height = std::tan(camera.angle / 2);
        right = height * camera.aspect * side;
        up = height * cross(side, towards);
    }
    /// From the eye to what is seen at a point of the image.
    Point ray(const ImagePoint& at) const { return towards + at[0] * right + at[1] * up; }
};

/// The sides of what is seen in a convex polygon that turns to the left.
std::vector<HalfSpace> sides_through(const Point& eye, const Eye& view,
                                     const std::vector<ImagePoint>& corners) {
    std::vector<HalfSpace> sides;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const ImagePoint& next = corners[(i + 1) % corners.size()];
        sides.emplace_back(eye, cross(view.ray(corners[i]), view.ray(next)));
    }
    return sides;
}

}  // namespace

Distance intersection(Distance a, Distance b) {
    return [a = std::move(a), b = std::move(b)](const Point& x) { return std::max(a(x), b(x)); };
}

Distance union_of(Distance a, Distance b) {
    return [a = std::move(a), b = std::move(b)](const Point& x) { return std::min(a(x), b(x)); };
}

double Ball::operator()(const Point& x) const { return std::max(norm(x - centre) - radius, 0.0); }

double Box::operator()(const Point& x) const {
    Point outside;
    for (std::size_t d = 0; d < 3; ++d) {
        outside[d] = std::max({low[d] - x[d], x[d] - high[d], 0.0});
    }
    return norm(outside);
}

HalfSpace::HalfSpace(const Point& through, const Point& normal)
    : normal_{unit(normal, "the normal of a half-space")}, offset_{dot(normal_, through)} {
    require_finite(through, "a point of a half-space");
}

double HalfSpace::operator()(const Point& x) const { return std::max(signed_distance(x), 0.0); }

ConvexPolyhedron::ConvexPolyhedron(std::vector<HalfSpace> sides) : sides_{std::move(sides)} {
    if (sides_.empty()) throw InvalidInput("a convex polyhedron has no side");
}

double ConvexPolyhedron::operator()(const Point& x) const {
    double greatest = 0;
    for (const HalfSpace& side : sides_) greatest = std::max(greatest, side.signed_distance(x));
    return greatest;
}

Cone::Cone(const Point& apex, const Point& towards, double angle)
    : apex_{apex},
      axis_{unit(towards, "the axis of a cone")},
      cos_{std::cos(angle)},
      sin_{std::sin(angle)} {
    require_finite(apex, "the apex of a cone");
    if (!(angle > 0 && angle < std::numbers::pi / 2)) {
        throw InvalidInput("a cone has an angle between 0 and pi / 2, not " +
                           std::to_string(angle));
    }
}

double Cone::operator()(const Point& x) const {
    const Point from = x - apex_;
    const double along = dot(axis_, from);
    const double across = norm(from - along * axis_);
    // Behind the normals of the cone at its apex, the apex is the nearest point.
    if (along * cos_ + across * sin_ < 0) return norm(from);
    return std::max(across * cos_ - along * sin_, 0.0);
}

Polygon::Polygon(std::vector<ImagePoint> corners) : corners_{std::move(corners)} {
    if (corners_.size() < 3) throw InvalidInput("a polygon has fewer than three corners");
    for (const ImagePoint& x : corners_) require_finite({x[0], x[1], 0}, "a corner of a polygon");
}

bool Polygon::contains(const ImagePoint& x) const {
    bool inside = false;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        const ImagePoint& a = corners_[i];
        const ImagePoint& b = corners_[(i + 1) % corners_.size()];
        if ((a[1] > x[1]) == (b[1] > x[1])) continue;
        const auto& [low, high] =
            std::minmax(a, b, [](const ImagePoint& p, const ImagePoint& q) { return p[1] < q[1]; });
        if (turn(low, high, x) > 0) inside = !inside;
    }
    return inside;
}

double Polygon::operator()(const Point& x) const {
    const ImagePoint at{x[0], x[1]};
    if (contains(at)) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
        least = std::min(
            least, distance_from_segment(at, corners_[i], corners_[(i + 1) % corners_.size()]));
    }
    return least;
}

Distance seen_in(const AffineCamera& camera, Distance domain) {
    // The greatest singular value of the matrix with the rows `across` and `up`.
    const double a = dot(camera.across, camera.across);
    const double b = dot(camera.across, camera.up);
    const double c = dot(camera.up, camera.up);
    const double stretch = std::sqrt((a + c) / 2 + std::hypot((a - c) / 2, b));
    if (!(stretch > 0) || !std::isfinite(stretch)) {
        throw InvalidInput("a camera maps all points to one, or has numbers that are not finite");
    }
    return [camera, stretch, domain = std::move(domain)](const Point& x) {
        return domain({dot(camera.across, x) + camera.offset[0],
                       dot(camera.up, x) + camera.offset[1], 0}) /
               stretch;
    };
}

ConvexPolyhedron view_frustum(const PerspectiveCamera& camera, double nearest, double farthest) {
    if (!(nearest >= 0 && nearest < farthest)) {
        throw InvalidInput("a view has distances 0 <= nearest < farthest, not " +
                           std::to_string(nearest) + " and " + std::to_string(farthest));
    }
    const Eye view(camera);
    auto sides = sides_through(camera.eye, view, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
    sides.emplace_back(camera.eye + nearest * view.towards, -1 * view.towards);
    if (std::isfinite(farthest)) {
        sides.emplace_back(camera.eye + farthest * view.towards, view.towards);
    }
    return ConvexPolyhedron(std::move(sides));
}

ConvexPolyhedron seen_in(const PerspectiveCamera& camera, const Polygon& polygon) {
    std::vector<ImagePoint> corners = polygon.corners();
    const std::size_t count = corners.size();
    const auto turn_at = [&](std::size_t i) {
        return turn(corners[i], corners[(i + 1) % count], corners[(i + 2) % count]);
    };
    if (turn_at(0) < 0) std::ranges::reverse(corners);
    double angle = 0;  // by which the sides turn in all
    for (std::size_t i = 0; i < count; ++i) {
        const ImagePoint& a = corners[i];
        const ImagePoint& b = corners[(i + 1) % count];
        const ImagePoint& c = corners[(i + 2) % count];
        if (!(turn_at(i) > 0)) throw InvalidInput("a polygon in a perspective image is not convex");
        angle +=
            std::atan2(turn_at(i), (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]));
    }
    if (angle > 3 * std::numbers::pi) {
        throw InvalidInput("a polygon in a perspective image crosses itself");
    }
    const Eye view(camera);
    auto sides = sides_through(camera.eye, view, corners);
    sides.emplace_back(camera.eye, -1 * view.towards);
    return ConvexPolyhedron(std::move(sides));
}

}  // namespace nestgrid
