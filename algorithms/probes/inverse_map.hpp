// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The map of a shape, sum over k of N_k(s) x_k with its shape functions N_k, and its inverse.
#pragma once

#include <span>

#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// How far off a surface in space, in parts of the size of an element, a point still lies on it.
inline constexpr double off_surface = 1e-6;

/// The least distance of a point s to the faces of the reference element, each measured along an
/// axis; negative outside.
inline double face_distance(Shape shape, const Point& s) {
    const auto [x, y, z] = s;
    const auto within = [](double t) { return t < 1 - t ? t : 1 - t; };
    const auto least = [](double a, double b) { return a < b ? a : b; };
    switch (shape) {
        case Shape::point:
            return 0;
        case Shape::segment:
            return within(x);
        case Shape::triangle:
            return least(least(x, y), 1 - x - y);
        case Shape::quadrilateral:
            return least(within(x), within(y));
        case Shape::tetrahedron:
            return least(least(x, y), least(z, 1 - x - y - z));
        case Shape::pyramid:
            return least(least(least(x, y), z), least(1 - x, 1 - y) - z);
        case Shape::prism:
            return least(least(least(x, y), 1 - x - y), within(z));
        case Shape::hexahedron:
            break;
    }
    return least(least(within(x), within(y)), within(z));
}

/// The middle of the corners of the reference element.
Point reference_middle(Shape shape);

/// The place of reference coordinates s in an element. They may lie outside the reference element.
Point place_of(Shape shape, std::span<const Point> corners, const Point& s);

/// Whether the map of an element is affine, up to rounding.
bool is_affine(Shape shape, std::span<const Point> corners);

/// The largest extent of the box of some points along an axis.
double extent(std::span<const Point> points);

/// By how much rounding, and what is known of a face from its two sides, may move a point in
/// reference coordinates.
double face_tolerance(std::span<const Point> corners);

/// Finds reference coordinates by Newton's method; of segments, triangles and quadrilaterals in
/// space those of the nearest point.
/// \param s where the search begins; takes the result
/// \return whether it converged, within a few diameters of the element
bool invert(Shape shape, std::span<const Point> corners, const Point& x, Point& s);

/// Weights of corners that add up to 1 and give a point x: those of reference coordinates s, moved
/// along the axes of the element by what the place of s is off. A linear function has its value.
std::array<double, max_corners> weights_near(Shape shape, std::span<const Point> corners,
                                             const Point& s, const Point& x);

/// The inverse of the map of an element: a matrix where that is affine, else Newton's method.
///
/// Newton's method from the middle may end nowhere, or at a second solution outside the element.
/// find() therefore divides the element until each part is known to hold no solution or gives one:
/// the map is linear in each coordinate of a cube (a pyramid and a prism are cubes with edges
/// shrunk to points), so that the image of a box lies in the convex hull of those of its corners.
class InverseMap {
public:
    InverseMap(Shape shape, std::span<const Point> corners);

    Shape shape() const { return shape_; }
    bool affine() const { return affine_; }
    std::span<const Point> corners() const { return {corner_.data(), topology(shape_).corners}; }
    /// Finds reference coordinates. \return whether there are any
    bool operator()(const Point& x, Point& s) const {
        if (!affine_) return invert(shape_, corners(), x, s = reference_middle(shape_));
        const Point d = x - corner_[0];
        s = {dot(row_[0], d), dot(row_[1], d), dot(row_[2], d)};
        return true;
    }

    /// Finds reference coordinates inside the element, or beside it by at most a tolerance.
    /// \return whether there are any
    bool find(const Point& x, double tolerance, Point& s) const;

private:
    bool find_in_box(const Point& x, double tolerance, const Point& low, double side,
                     Point& s) const;
    bool find_in_parts(const Point& x, double tolerance, const Point& low, double side,
                       Point& s) const;

    Shape shape_;
    bool affine_;
    std::array<Point, max_corners> corner_{};
    std::array<Point, 3> row_{};  // of the inverse of the derivative
};

}  // namespace nestgrid::engine
