// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/separated.hpp>

namespace nestgrid::engine {

namespace {

constexpr double separation_rounding = 1e-12;  // in parts of the bodies' size

/// Two bodies, seen from a corner of one.
template <std::size_t count_a, std::size_t count_b>
class Pair {
public:
    Pair(const std::array<Point, count_a>& a, const std::array<Point, count_b>& b) {
        Box box;
        for (std::size_t i = 0; i < count_a; ++i) box.add(a_[i] = a[i] - b[0]);
        for (std::size_t i = 0; i < count_b; ++i) box.add(b_[i] = b[i] - b[0]);
        size_ = box.diameter();
    }
    /// Whether the bodies lie beside each other along an axis.
    bool apart_along(const Point& axis) const {
        const auto [a_low, a_high] = extent(a_, axis);
        const auto [b_low, b_high] = extent(b_, axis);
        const double gap = std::max(a_low - b_high, b_low - a_high);
        if (gap > 0) return true;
        // An axis without a direction, or along which neither body has an extent, tells nothing.
        const double slack = separation_rounding * size_ * norm(axis);
        const bool flat = std::max(a_high, b_high) - std::min(a_low, b_low) <= 2 * slack;
        return gap >= -slack && !flat;
    }

private:
    /// The least and the greatest place of some points along an axis.
    static std::array<double, 2> extent(std::span<const Point> points, const Point& axis) {
        std::array<double, 2> range{Box::infinity, -Box::infinity};
        for (const Point& x : points) {
            const double at = dot(axis, x);
            range = {std::min(range[0], at), std::max(range[1], at)};
        }
        return range;
    }

    std::array<Point, count_a> a_;
    std::array<Point, count_b> b_;
    double size_;
};

}  // namespace

bool separated(const Tetrahedron& body, const Triangle& triangle) {
    const Pair<4, 3> pair(body, triangle);
    const std::array<Point, 3> side{triangle[1] - triangle[0], triangle[2] - triangle[1],
                                    triangle[0] - triangle[2]};
    const std::array<Point, 6> edge{body[1] - body[0], body[2] - body[0], body[3] - body[0],
                                    body[2] - body[1], body[3] - body[1], body[3] - body[2]};
    const Point normal = cross(side[0], side[1]);
    if (pair.apart_along(normal)) return true;
    for (const auto& [i, j] : {std::pair{0U, 1U}, {0U, 2U}, {1U, 2U}, {3U, 4U}}) {
        if (pair.apart_along(cross(edge[i], edge[j]))) return true;
    }
    for (const Point& s : side) {
        for (const Point& e : edge) {
            if (pair.apart_along(cross(s, e))) return true;
        }
    }
    // All in one plane: axes in it.
    for (const Point& s : side) {
        if (pair.apart_along(cross(s, normal))) return true;
    }
    for (const Point& e : edge) {
        if (pair.apart_along(cross(e, normal))) return true;
    }
    return false;
}

bool separated(const Triangle& a, const Triangle& b) {
    const Pair<3, 3> pair(a, b);
    const std::array<Point, 3> of_a{a[1] - a[0], a[2] - a[1], a[0] - a[2]};
    const std::array<Point, 3> of_b{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
    const Point normal_a = cross(of_a[0], of_a[1]);
    const Point normal_b = cross(of_b[0], of_b[1]);
    if (pair.apart_along(normal_a) || pair.apart_along(normal_b)) return true;
    for (const Point& s : of_a) {
        for (const Point& t : of_b) {
            if (pair.apart_along(cross(s, t))) return true;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        if (pair.apart_along(cross(of_a[i], normal_a))) return true;
        if (pair.apart_along(cross(of_b[i], normal_b))) return true;
    }
    return false;
}

}  // namespace nestgrid::engine
