// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <string>

namespace nestgrid {

/// A point or vector in space. Grids of lower dimension leave the last coordinates zero or, for
/// surfaces in space, use all three. Units are the grid's own.
using Point = std::array<double, 3>;

constexpr Point operator-(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

constexpr Point operator+(const Point& a, const Point& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

constexpr Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }

constexpr double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double norm(const Point& a) { return std::sqrt(dot(a, a)); }

/// As in "(0.500000, 0.000000, 1.000000)", for sentences.
std::string text_of(const Point& x);

}  // namespace nestgrid
