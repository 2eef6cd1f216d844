// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <probes/inverse_map.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

namespace {

/// The shape functions, continued as affine functions above the apex of a pyramid.
std::array<double, max_corners> weights(Shape shape, const Point& s) {
    if (shape == Shape::pyramid && s[2] >= 1) return {1 - s[0] - s[1] - s[2], s[0], s[1], 0, s[2]};
    return shape_functions(shape, s);
}

/// Derivative of the map along axis d. All shape functions are affine along each axis, but for the
/// axis of a pyramid.
Point derivative(Shape shape, std::span<const Point> x, const Point& s, const Point& place,
                 std::size_t d) {
    if (shape == Shape::pyramid && d == 2) {
        const double h = 1 - s[2];
        const double twist = h > 0 ? s[0] * s[1] / (h * h) : 0;
        return x[4] - x[0] + twist * (x[0] - x[1] + (x[3] - x[2]));
    }
    Point next = s;
    next[d] += 1;
    return place_of(shape, x, next) - place;
}

/// Solves a[0] d[0] + a[1] d[1] + a[2] d[2] = r, by least squares where the dimension is below 3.
Point solve(std::array<Point, 3> a, int dimension, const Point& r) {
    if (dimension == 1) return {dot(a[0], r) / dot(a[0], a[0]), 0, 0};
    if (dimension == 2) a[2] = cross(a[0], a[1]);
    const Point normal = cross(a[1], a[2]);
    const double determinant = dot(a[0], normal);
    Point d{dot(r, normal) / determinant, dot(r, cross(a[2], a[0])) / determinant, 0};
    if (dimension == 3) d[2] = dot(r, cross(a[0], a[1])) / determinant;
    return d;
}

}  // namespace

Point reference_middle(Shape shape) {
    const Topology& t = topology(shape);
    Point sum{0, 0, 0};
    for (std::size_t k = 0; k < t.corners; ++k) sum = sum + t.reference[k];
    return (1.0 / t.corners) * sum;
}

Point place_of(Shape shape, std::span<const Point> corners, const Point& s) {
    const auto w = weights(shape, s);
    Point x{0, 0, 0};
    for (std::size_t k = 0; k < topology(shape).corners; ++k) x = x + w[k] * corners[k];
    return x;
}

double extent(std::span<const Point> points) {
    double largest = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        const auto [low, high] =
            std::ranges::minmax(points, {}, [d](const Point& x) { return x[d]; });
        largest = std::max(largest, high[d] - low[d]);
    }
    return largest;
}

bool is_affine(Shape shape, std::span<const Point> corners) {
    const Topology& t = topology(shape);
    if (is_simplex(shape)) return true;
    const double tolerance = 1e-13 * extent(corners);
    const std::size_t up = shape == Shape::quadrilateral ? 0 : shape == Shape::prism ? 3 : 4;
    for (std::size_t k = 0; k < t.corners; ++k) {
        const auto [x, y, z] = t.reference[k];
        const Point along = x * (corners[1] - corners[0]) + y * (corners[2] - corners[0]);
        const Point off = corners[k] - (corners[0] + along + z * (corners[up] - corners[0]));
        if (!(norm(off) <= tolerance)) return false;
    }
    return true;
}

double face_tolerance(std::span<const Point> corners) {
    double largest = 0;
    for (const Point& x : corners) largest = std::max(largest, norm(x));
    const double rounding = std::numeric_limits<double>::epsilon() * largest;
    return 1e-9 + 64 * rounding / extent(corners);
}

bool invert(Shape shape, std::span<const Point> corners, const Point& x, Point& s) {
    constexpr int most_steps = 40;
    constexpr double quadratic = 1e-8;  // a step below it leaves rounding
    constexpr double far = 8;
    const int dimension = topology(shape).dimension;
    for (int i = 0; i < most_steps; ++i) {
        const Point place = place_of(shape, corners, s);
        std::array<Point, 3> jacobian{};
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
            jacobian[d] = derivative(shape, corners, s, place, d);
        }
        const Point step = solve(jacobian, dimension, x - place);
        const double length = norm(step);
        if (!(length < std::numeric_limits<double>::max())) return false;
        s = s + (length > 1 ? 1 / length : 1) * step;
        if (!(norm(s) < far)) return false;
        if (length < quadratic) return true;
    }
    return false;
}

InverseMap::InverseMap(Shape shape, std::span<const Point> corners)
    : shape_{shape}, affine_{is_affine(shape, corners)} {
    std::ranges::copy(corners, corner_.begin());
    const auto dimension = static_cast<std::size_t>(topology(shape).dimension);
    std::array<Point, 3> a{};
    for (std::size_t d = 0; d < dimension; ++d) {
        a[d] = derivative(shape, corners, {0, 0, 0}, corners[0], d);
    }
    if (dimension == 1) {
        row_[0] = (1 / dot(a[0], a[0])) * a[0];
        return;
    }
    if (dimension == 2) a[2] = cross(a[0], a[1]);
    const double determinant = dot(a[0], cross(a[1], a[2]));
    row_[0] = (1 / determinant) * cross(a[1], a[2]);
    row_[1] = (1 / determinant) * cross(a[2], a[0]);
    if (dimension == 3) row_[2] = (1 / determinant) * cross(a[0], a[1]);
}

}  // namespace nestgrid::engine
