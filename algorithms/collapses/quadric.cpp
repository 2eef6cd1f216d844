// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/quadric.hpp>

#include <algorithm>
#include <utility>

namespace nestgrid::engine {

namespace {

constexpr double stiffness = 1e-3;  // of what holds a point near the middle of its edge

/// Solves a symmetric positive system of at most three unknowns by Gaussian elimination.
template <std::size_t most>
void solve(std::array<std::array<double, most>, most>& a, std::array<double, most>& b,
           std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
        for (std::size_t i = k + 1; i < count; ++i) {
            const double factor = a[i][k] / a[k][k];
            for (std::size_t j = k; j < count; ++j) a[i][j] -= factor * a[k][j];
            b[i] -= factor * b[k];
        }
    }
    for (std::size_t k = count; k-- > 0;) {
        for (std::size_t j = k + 1; j < count; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
}

}  // namespace

void Quadric::add_plane(const Point& normal, double level, double weight) {
    const auto [x, y, z] = normal;
    xx_ += weight * x * x;
    xy_ += weight * x * y;
    xz_ += weight * x * z;
    yy_ += weight * y * y;
    yz_ += weight * y * z;
    zz_ += weight * z * z;
    linear_ = linear_ - (weight * level) * normal;
    constant_ += weight * level * level;
}

void Quadric::add(const Quadric& other) {
    xx_ += other.xx_;
    xy_ += other.xy_;
    xz_ += other.xz_;
    yy_ += other.yy_;
    yz_ += other.yz_;
    zz_ += other.zz_;
    linear_ = linear_ + other.linear_;
    constant_ += other.constant_;
}

Point Quadric::times(const Point& d) const {
    return {xx_ * d[0] + xy_ * d[1] + xz_ * d[2], xy_ * d[0] + yy_ * d[1] + yz_ * d[2],
            xz_ * d[0] + yz_ * d[1] + zz_ * d[2]};
}

Point Quadric::slope(const Point& x) const { return times(x) + linear_; }

double Quadric::at(const Point& x) const { return dot(x, times(x) + 2.0 * linear_) + constant_; }

Point Quadric::least(const Point& near, const Freedom& planes) const {
    std::array<Point, 3> axis;
    const std::size_t count = planes.directions(axis);
    std::array<std::array<double, 3>, 3> a{};
    std::array<double, 3> b{};
    const Point down = slope(near);
    const double hold = stiffness * trace() + 1e-30;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) a[i][j] = dot(axis[i], times(axis[j]));
        a[i][i] += hold;
        b[i] = -dot(axis[i], down);
    }
    solve(a, b, count);
    Point x = near;
    for (std::size_t i = 0; i < count; ++i) x = x + b[i] * axis[i];
    return x;
}

}  // namespace nestgrid::engine
