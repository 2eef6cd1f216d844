// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The distance between two surfaces, by brute force over points of them.
#pragma once

#include <cmath>

#include "triangle_samples.hpp"

namespace nestgrid_test {

inline double square(const Point& x) { return dot(x, x); }

/// The square of the distance from a triangle: a minimum over its plane, or over its sides.
inline double square_distance(const Point& p, const std::array<Point, 3>& t) {
    const Point u = t[1] - t[0];
    const Point v = t[2] - t[0];
    const Point w = p - t[0];
    const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const double det = uu * vv - uv * uv;
    const double a = vv * uw - uv * vw;
    const double b = uu * vw - uv * uw;
    if (det > 0 && a >= 0 && b >= 0 && a + b <= det) {
        return square(w - (a / det) * u - (b / det) * v);
    }
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point side = t[(i + 1) % 3] - t[i];
        const double length = square(side);
        const double at = length > 0 ? std::clamp(dot(p - t[i], side) / length, 0.0, 1.0) : 0;
        least = std::min(least, square(p - t[i] - at * side));
    }
    return least;
}

/// The greatest distance that points of one surface have from another one.
inline double greatest_distance(const Surface<3>& from, const Surface<3>& to,
                                double sample_length) {
    struct Ball {
        Point middle{};
        double radius = 0;
    };
    std::vector<Ball> balls;
    for (std::size_t t = 0; t < to.simplices.size(); ++t) {
        const auto x = corners_of(to, t);
        Ball ball{(1.0 / 3) * (x[0] + x[1] + x[2])};
        for (const Point& corner : x)
            ball.radius = std::max(ball.radius, norm(corner - ball.middle));
        balls.push_back(ball);
    }
    double greatest = 0;
    std::size_t near = 0;  // of the point before
    for (std::size_t f = 0; f < from.simplices.size(); ++f) {
        const auto x = corners_of(from, f);
        const double side = std::max({norm(x[1] - x[0]), norm(x[2] - x[1]), norm(x[0] - x[2])});
        const int steps = std::clamp(static_cast<int>(std::ceil(side / sample_length)), 1, 40);
        for (const Point& p : samples_of(x, steps)) {
            double least =
                balls.empty() ? HUGE_VAL : norm(p - balls[near].middle) + balls[near].radius;
            for (std::size_t t = 0; t < balls.size() && least > greatest; ++t) {
                if (square(p - balls[t].middle) > std::pow(least + balls[t].radius, 2)) continue;
                const double off = std::sqrt(square_distance(p, corners_of(to, t)));
                if (off > least) continue;
                least = off;
                near = t;
            }
            greatest = std::max(greatest, least);
        }
    }
    return greatest;
}

/// The distance is kept there and back.
inline void expect_kept(const Surface<3>& s, const Surface<3>& whole, double distance) {
    EXPECT_LE(greatest_distance(s, whole, distance / 2), distance * (1 + 1e-9));
    EXPECT_LE(greatest_distance(whole, s, distance / 2), distance * (1 + 1e-9));
}

}  // namespace nestgrid_test
