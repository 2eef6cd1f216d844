// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/widest_direction.hpp>

#include <algorithm>

namespace nestgrid::engine {

namespace {

/// A direction counts as within a cone up to this difference of cosines.
constexpr double cosine_rounding = 1e-14;

/// A circular cone around some directions.
struct Cone {
    Point axis;
    double cosine;  ///< of the angle between the axis and the cone

    bool holds(const Point& direction) const {
        return dot(axis, direction) >= cosine - cosine_rounding;
    }
};

Point unit(const Point& v) {
    const double length = norm(v);
    return length > 0 ? (1 / length) * v : Point{0, 0, 0};
}

/// The least cone around two directions, which lie on it.
Cone cone_of(const Point& a, const Point& b) {
    const Point axis = unit(a + b);
    return {axis, std::min(dot(axis, a), dot(axis, b))};
}

/// The cone around three directions, which lie on it.
Cone cone_of(const Point& a, const Point& b, const Point& c) {
    Point axis = unit(cross(b - a, c - a));
    if (dot(axis, a) < 0) axis = -1.0 * axis;
    return {axis, std::min({dot(axis, a), dot(axis, b), dot(axis, c)})};
}

}  // namespace

double least_cosine(const Point& direction, std::span<const Point> others) {
    double least = 1;
    for (const Point& other : others) least = std::min(least, dot(direction, other));
    return least;
}

/// Adds one direction after the other (Welzl's algorithm). One that lies outside the cone of those
/// before it lies on the cone of all.
Agreement widest_direction(std::span<const Point> others) {
    Cone cone{others[0], 1};
    for (std::size_t i = 1; i < others.size(); ++i) {
        if (cone.holds(others[i])) continue;
        cone = {others[i], 1};
        for (std::size_t j = 0; j < i; ++j) {
            if (cone.holds(others[j])) continue;
            cone = cone_of(others[i], others[j]);
            for (std::size_t k = 0; k < j; ++k) {
                if (!cone.holds(others[k])) cone = cone_of(others[i], others[j], others[k]);
            }
        }
    }
    return {cone.axis, least_cosine(cone.axis, others)};
}

}  // namespace nestgrid::engine
