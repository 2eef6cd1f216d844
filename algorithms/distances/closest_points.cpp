// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <distances/closest_points.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nestgrid::engine {

namespace {

double square(const Point& x) { return dot(x, x); }

double square_distance_of_segment(const Point& x, const Point& a, const Point& b) {
    const Point ab = b - a;
    const double length = square(ab);
    const double along = length > 0 ? std::clamp(dot(x - a, ab) / length, 0.0, 1.0) : 0;
    return square(x - (a + along * ab));
}

/// The bits of a number of 21 bits, with two zeros between them.
std::uint64_t spread_bits(std::uint64_t n) {
    n = (n | n << 32U) & 0x1F00000000FFFFU;
    n = (n | n << 16U) & 0x1F0000FF0000FFU;
    n = (n | n << 8U) & 0x100F00F00F00F00FU;
    n = (n | n << 4U) & 0x10C30C30C30C30C3U;
    return (n | n << 2U) & 0x1249249249249249U;
}

/// The place of a point on the Z curve through a box.
std::uint64_t place_on_curve(const Point& x, const Box& box) {
    constexpr double last = (1 << 21) - 1;
    std::uint64_t place = 0;
    for (std::size_t d = 0; d < 3; ++d) {
        const double extent = box.high[d] - box.low[d];
        const double part = extent > 0 ? (x[d] - box.low[d]) / extent : 0;
        place |= spread_bits(static_cast<std::uint64_t>(std::clamp(part, 0.0, 1.0) * last)) << d;
    }
    return place;
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

ClosestPoints::ClosestPoints(const Surface<3>& surface)
    : surface_{&surface}, order_(surface.simplices.size()) {
    Box all;
    for (const Point& x : surface.vertices) all.add(x);
    std::vector<std::uint64_t> place;
    place.reserve(order_.size());
    for (std::uint32_t t = 0; t < order_.size(); ++t) {
        const Triangle x = triangle(t);
        place.push_back(place_on_curve((1.0 / 3) * (x[0] + x[1] + x[2]), all));
    }
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(place[a], a) < std::pair(place[b], b);
    });
    for (const std::uint32_t t : order_) tree_.add(Box::around(triangle(t)));
    tree_.finish();
}

double ClosestPoints::distance(const Point& x, double bound) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double least = infinity;
    double limit = bound < infinity ? bound * bound * (1 + 1e-9) : infinity;  // more than rounding
    const auto meets = [&](const Box& box) { return box.square_distance(x) <= limit; };
    tree_.for_each(meets, [&](std::size_t i) {
        least = std::min(least, square_distance(x, triangle(order_[i])));
        limit = std::min(limit, least);
        return true;
    });
    return std::sqrt(least);
}

}  // namespace nestgrid::engine
