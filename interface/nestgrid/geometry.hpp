// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

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

/// Where an edge is cut, seen from its lower end: nowhere nearer than this to an end, in edges.
inline constexpr double least_cut_fraction = 0x1p-20;

/// \tparam Number double, or several at once
/// \param low, high U at the ends, low < isovalue <= high
/// \param least, most least_cut_fraction, and 1 less it
template <class Number>
constexpr Number cut_fraction(const Number& isovalue, const Number& low, const Number& high,
                              const Number& least, const Number& most) {
    using std::max;
    using std::min;
    return min(max((isovalue - low) / (high - low), least), most);
}

constexpr double cut_fraction(double isovalue, double low, double high) {
    return cut_fraction(isovalue, low, high, least_cut_fraction, 1 - least_cut_fraction);
}

}  // namespace nestgrid
