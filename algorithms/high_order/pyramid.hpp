// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Polynomials on pyramids: of degree p in each of the coordinates a, b, c of a box whose upper face
// is collapsed to the apex: x = a (1 - c), y = b (1 - c), z = c. So their net is that of a box.
// These are all functions of pyramids in use: on the base they are those of a quadrilateral, on the
// triangles, as long as they are continuous, polynomials of degree p, inside they are rational.
// A pyramid below a leaf has other coordinates, in which U is no such function. So elements below a
// leaf are looked at in a box in a, b, c around them. Invariants:
//   - the box around a part is a function of the corners of the part alone, to the last bit;
//   - beta of a part below a leaf falls by 4 at least from part to half, and that of an edge is at
//     most that of a face around it.
// Consequence: as for nets (net.hpp), without halving.
#pragma once

#include <cmath>

#include <high_order/shape_parts.hpp>

namespace nestgrid::engine {

/// \param at in units of 2^-level
Point point_at(const Place& at, int level);
/// A point of the reference pyramid in the coordinates of the box.
Point collapsed(const Point& x);
/// The points at which a field is asked for its values: the net_points() of the box.
std::vector<Point> pyramid_points(int degree);

/// How far values at the corners are at most from the affine function that fits them best.
inline double pyramid_residual(std::span<const double> u) {
    return std::abs(u[0] - u[1] - u[2] + u[3]) / 4;
}

/// A box in a, b and c.
struct CollapsedBox {
    Point low;
    Point high;

    /// \param points in units of 2^-level; at the apex a and b are those of the others
    CollapsedBox(std::span<const Place> points, int level);
    /// Puts the coefficients of a pyramid in the box.
    void restrict_net(const double* net, int degree, double* out) const;
    /// How far a function with these coefficients in the box may be from an affine one.
    /// \param x corner 0 of an element and the ends of its axes \param u the affine function there
    double distance_from_affine(const double* net, int degree, std::span<const Point, 4> x,
                                std::span<const double, 4> u) const;
};

/// The four nets on the triangles of a pyramid, one behind the other, each in the coordinate x or
/// y and in z.
std::size_t triangle_nets_size(int degree);
/// \return how far the polynomial is from those at most: they are of degree p
double put_triangle_nets(const double* net, int degree, double* out);
/// As take_part() of net.hpp, in a pyramid. \param triangles its triangle nets
void take_pyramid_part(const double* net, const double* triangles, int degree,
                       std::span<const Place> frame, const Factors& part, double* out);

/// Second derivatives of a polynomial along x, y and z, times (1 - c)^2: polynomials again.
class PyramidCurvature {
public:
    PyramidCurvature() = default;
    PyramidCurvature(const double* net, int degree);
    /// |u - I u| is at most this between the corners of an edge, face or element; I interpolates as
    /// on simplices, in a pyramid as in two. Infinity at the apex.
    /// \param x in units of 2^-level, in the order of the shape
    double beta(Shape shape, std::span<const Place> x, int level) const;

private:
    double second_along(const CollapsedBox& box, const Point& step) const;

    int degree_ = 1;
    std::array<std::vector<double>, 6> second_;  // xx, xy, yy, xz, yz, zz
};

}  // namespace nestgrid::engine
