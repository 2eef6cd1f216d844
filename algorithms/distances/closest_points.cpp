// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/closest_points.hpp>

#include <algorithm>
#include <cmath>

#include <distances/curve_order.hpp>

namespace nestgrid::engine {

namespace {

double square(const Point& x) { return dot(x, x); }

double square_distance_of_segment(const Point& x, const Point& a, const Point& b) {
    const Point ab = b - a;
    const double length = square(ab);
    const double along = length > 0 ? std::clamp(dot(x - a, ab) / length, 0.0, 1.0) : 0;
    return square(x - (a + along * ab));
}

}  // namespace

double square_distance(const Point& x, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    const Point normal = cross(b - a, c - a);
    const double area = square(normal);
    // Over the triangle the nearest point is the foot of the perpendicular.
    const auto inside = [&](const Point& from, const Point& to) {
        return dot(cross(to - from, x - from), normal) >= 0;
    };
    if (area > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
        const double height = dot(x - a, normal);
        return height * height / area;
    }
    return std::min({square_distance_of_segment(x, a, b), square_distance_of_segment(x, b, c),
                     square_distance_of_segment(x, c, a)});
}

ClosestPoints::ClosestPoints(const Surface<3>& surface) : surface_{&surface} {
    std::vector<Point> middle;
    middle.reserve(surface.simplices.size());
    for (std::uint32_t t = 0; t < surface.simplices.size(); ++t) {
        const Triangle x = triangle(t);
        middle.push_back((1.0 / 3) * (x[0] + x[1] + x[2]));
    }
    order_ = order_on_curve(middle);
    for (const std::uint32_t t : order_) tree_.add(Box::around(triangle(t)));
    tree_.finish();
}

ClosestPoints::Nearest ClosestPoints::nearest(const Point& x, double bound) const {
    double least = infinity;
    std::uint32_t triangle = 0;
    double limit = bound < infinity ? bound * bound * (1 + 1e-9) : infinity;  // more than rounding
    const auto meets = [&](const Box& box) { return box.square_distance(x) <= limit; };
    tree_.for_each(meets, [&](std::size_t i) {
        const double square = square_distance(x, this->triangle(order_[i]));
        if (square < least) {
            least = square;
            triangle = order_[i];
        }
        limit = std::min(limit, least);
        return true;
    });
    return {std::sqrt(least), triangle};
}

bool ClosestPoints::is_within(const Point& x, double limit, std::uint32_t& near) const {
    const double square = limit * limit;
    const auto is_near = [&](std::uint32_t t) { return square_distance(x, triangle(t)) <= square; };
    if (near < order_.size() && is_near(near)) return true;
    return !tree_.for_each([&](const Box& box) { return box.square_distance(x) <= square; },
                           [&](std::size_t i) {
                               if (!is_near(order_[i])) return true;
                               near = order_[i];
                               return false;
                           });
}

bool ClosestPoints::holds(std::uint32_t triangle, std::span<const Point> points,
                          double limit) const {
    const Triangle t = this->triangle(triangle);
    return std::all_of(points.begin(), points.end(),
                       [&](const Point& x) { return square_distance(x, t) <= limit * limit; });
}

}  // namespace nestgrid::engine
