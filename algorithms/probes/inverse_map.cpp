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

/// The reference coordinates of a point of the cube: layers of a pyramid and rows of a triangle are
/// as long as its side.
Point from_cube(Shape shape, const Point& at) {
    const auto [x, y, z] = at;
    switch (shape) {
        case Shape::triangle:
        case Shape::prism:
            return {x * (1 - y), y, z};
        case Shape::pyramid:
            return {x * (1 - z), y * (1 - z), z};
        case Shape::tetrahedron:
            return {x * (1 - y) * (1 - z), y * (1 - z), z};
        default:
            return at;
    }
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

std::array<double, max_corners> weights_near(Shape shape, std::span<const Point> corners,
                                             const Point& s, const Point& x) {
    constexpr double step = 0.25;  // from the middle, inside the element
    const Topology& t = topology(shape);
    const Point middle = reference_middle(shape);
    std::array<std::array<double, max_corners>, 3> change{};  // of the weights along each axis
    std::array<Point, 3> axis{};
    for (std::size_t d = 0; d < static_cast<std::size_t>(t.dimension); ++d) {
        Point to = middle;
        to[d] += step;
        const auto there = weights(shape, to);
        const auto here = weights(shape, middle);
        for (std::size_t k = 0; k < t.corners; ++k) {
            change[d][k] = there[k] - here[k];
            axis[d] = axis[d] + change[d][k] * corners[k];
        }
    }
    const Point by = solve(axis, t.dimension, x - place_of(shape, corners, s));
    auto result = weights(shape, s);
    for (std::size_t k = 0; k < t.corners; ++k) {
        for (std::size_t d = 0; d < 3; ++d) result[k] += by[d] * change[d][k];
    }
    return result;
}

bool InverseMap::find(const Point& x, double tolerance, Point& s) const {
    if (affine_) return (*this)(x, s) && face_distance(shape_, s) >= -tolerance;
    return find_in_box(x, tolerance, {0, 0, 0}, 1, s);
}

/// \param low, side a box of the cube
bool InverseMap::find_in_box(const Point& x, double tolerance, const Point& low, double side,
                             Point& s) const {
    constexpr double least_side = 0x1p-6;
    const auto dimension = static_cast<std::size_t>(topology(shape_).dimension);
    const double half = 0.5 * side;
    const Point middle = from_cube(shape_, low + half * Point{1, 1, 1});
    if (invert(shape_, corners(), x, s = middle) && face_distance(shape_, s) >= -tolerance) {
        return true;
    }
    // Where the inverse of the derivative takes the box, 0 is what is sought.
    const Point place = place_of(shape_, corners(), middle);
    std::array<Point, 3> jacobian{};
    for (std::size_t d = 0; d < dimension; ++d) {
        jacobian[d] = derivative(shape_, corners(), middle, place, d);
    }
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Point least{infinity, infinity, infinity};
    Point greatest{-infinity, -infinity, -infinity};
    for (unsigned k = 0; k < 1U << dimension; ++k) {
        const Point at{double(k & 1U), double(k >> 1U & 1U), double(k >> 2U)};
        const Point image = place_of(shape_, corners(), from_cube(shape_, low + side * at));
        const Point y = solve(jacobian, static_cast<int>(dimension), image - x);
        for (std::size_t d = 0; d < dimension; ++d) {
            if (!std::isfinite(y[d]))
                return side > least_side && find_in_parts(x, tolerance, low, half, s);
            least[d] = std::min(least[d], y[d]);
            greatest[d] = std::max(greatest[d], y[d]);
        }
    }
    for (std::size_t d = 0; d < dimension; ++d) {
        if (least[d] > tolerance || greatest[d] < -tolerance) return false;
    }
    return side > least_side && find_in_parts(x, tolerance, low, half, s);
}

bool InverseMap::find_in_parts(const Point& x, double tolerance, const Point& low, double side,
                               Point& s) const {
    const unsigned parts = 1U << static_cast<unsigned>(topology(shape_).dimension);
    for (unsigned k = 0; k < parts; ++k) {
        const Point at{double(k & 1U), double(k >> 1U & 1U), double(k >> 2U)};
        if (find_in_box(x, tolerance, low + side * at, side, s)) return true;
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
