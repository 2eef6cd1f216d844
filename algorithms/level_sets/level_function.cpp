// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/level_function.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <nestgrid/detail/geometry.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid {

namespace {

void require_finite_coordinates(const Point& x, const char* what) {
    for (const double coordinate : x) {
        if (!std::isfinite(coordinate)) {
            throw InvalidInput(std::string(what) + " has a coordinate that is not a finite number");
        }
    }
}

/// The vector scaled to length 1, without overflow on the way.
Point direction(const Point& vector, const char* what) {
    require_finite_coordinates(vector, what);
    const double greatest =
        std::max({std::abs(vector[0]), std::abs(vector[1]), std::abs(vector[2])});
    if (!(greatest > 0)) throw InvalidInput(std::string(what) + " is 0");
    const Point scaled{vector[0] / greatest, vector[1] / greatest, vector[2] / greatest};
    return (1 / norm(scaled)) * scaled;
}

void require_radius(double radius, const char* what) {
    if (!(radius > 0) || !std::isfinite(radius)) {
        throw InvalidInput(std::string("the radius of ") + what + " is not a positive number");
    }
}

}  // namespace

Plane::Plane(const Point& through, const Point& normal)
    : normal_{direction(normal, "the normal of the plane")}, offset_{dot(normal_, through)} {
    require_finite_coordinates(through, "the point on the plane");
}
double Plane::value(const Point& x) const { return dot(normal_, x) - offset_; }
double Plane::variation(const Point& /*centre*/, double radius) const { return radius; }

Sphere::Sphere(const Point& centre, double radius) : centre_{centre}, radius_{radius} {
    require_finite_coordinates(centre, "the centre of the sphere");
    require_radius(radius, "the sphere");
}
double Sphere::value(const Point& x) const { return norm(x - centre_) - radius_; }
double Sphere::variation(const Point& /*centre*/, double radius) const { return radius; }

Cylinder::Cylinder(const Point& through, const Point& axis, double radius)
    : through_{through}, axis_{direction(axis, "the axis of the cylinder")}, radius_{radius} {
    require_finite_coordinates(through, "the point on the cylinder's axis");
    require_radius(radius, "the cylinder");
}
double Cylinder::value(const Point& x) const {
    const Point from = x - through_;
    return norm(from - dot(axis_, from) * axis_) - radius_;
}
double Cylinder::variation(const Point& /*centre*/, double radius) const { return radius; }

}  // namespace nestgrid
