// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/settle_normals.hpp>

#include <algorithm>
#include <limits>
#include <tuple>
#include <vector>

#include <nestgrid/algorithms/normals.hpp>
#include <surfaces/widest_direction.hpp>

namespace nestgrid {

namespace engine {

namespace {

using CornerNumbers = std::array<std::uint32_t, 3>;  // of a triangle

constexpr double least_of_gradient = 0.2;  // with each triangle
constexpr double least_with_mean = 0.5;    // of a gradient that says anything
constexpr double least_of_mean = 0.02;     // with each triangle; more than eight bits round away

/// Triangles of less height, in distances from the origin, have no direction.
constexpr double least_height = 1e-10;

/// The direction of a triangle, of unit length, and twice its area.
struct FanTriangle {
    Point direction;
    double area;
};

/// The first direction, on the way from one to another that agrees with all triangles of a fan,
/// whose cosine with each is at least a number that the other one's are, too. Along this way the
/// product with each triangle is linear.
Point first_agreeing(const Point& from, const Point& to, std::span<const Point> fan, double least) {
    double way = 0;
    for (const Point& triangle : fan) {
        const double before = dot(from, triangle);
        const double after = dot(to, triangle);
        if (before < least) way = std::max(way, (least - before) / (after - before));
    }
    Point direction = (1 - way) * from + way * to;
    direction = (1 / norm(direction)) * direction;
    // Opposite directions have hardly any between them.
    return least_cosine(direction, fan) > 0 ? direction : to;
}

class SettledNormals {
public:
    SettledNormals(std::span<const CornerNumbers> triangles, std::span<const Point> x,
                   std::span<Point> normals, double extent)
        : triangles_{triangles},
          x_{x},
          normals_{normals},
          extent_{extent},
          place_(normals.size(), accepted) {}

    std::size_t run() {
        refuse();
        if (refused_.empty()) return 0;
        list_fans();
        std::size_t folded = 0;
        for (std::size_t i = 0; i < refused_.size(); ++i) folded += settle(i) ? 0U : 1U;
        return folded;
    }

private:
    static constexpr std::uint32_t accepted = std::numeric_limits<std::uint32_t>::max();

    /// The direction of a triangle and twice its area, which is 0 where rounding decides about the
    /// direction.
    FanTriangle look_at(const CornerNumbers& t) const {
        const Point a = x_[t[1]] - x_[t[0]];
        const Point b = x_[t[2]] - x_[t[0]];
        const Point n = cross(a, b);
        const double area = norm(n);
        if (area <= least_height * extent_ * std::max(norm(a), norm(b))) return {{0, 0, 0}, 0};
        return {(1 / area) * n, area};
    }

    /// Whether the normals at the corners agree with a triangle so well that rounding does not
    /// matter: without roots and divisions, and mostly the case. No for any that overflow.
    bool agrees_clearly(const CornerNumbers& t) const {
        const Point n = cross(x_[t[1]] - x_[t[0]], x_[t[2]] - x_[t[0]]);
        const double least = 1.01 * least_of_gradient * least_of_gradient * dot(n, n);
        const auto agrees = [&](std::uint32_t v) {
            const double along = dot(normals_[v], n);
            return along > 0 && along * along > least;
        };
        return agrees(t[0]) && agrees(t[1]) && agrees(t[2]);
    }

    template <class Function>
    void for_each_of_fans(const Function& function) const;

    void refuse();
    void list_fans();
    bool settle(std::size_t i);

    std::span<const CornerNumbers> triangles_;
    std::span<const Point> x_;
    std::span<Point> normals_;
    double extent_;                       // the greatest distance from the origin
    std::vector<std::uint32_t> place_;    // by vertex: its place among the refused
    std::vector<std::uint32_t> refused_;  // vertices whose normals are refused
    std::vector<std::uint32_t> first_;    // of each of these: its first triangle, and the end
    std::vector<FanTriangle> fans_;       // the triangles around each of them
    std::vector<Point> fan_;              // directions of the triangles around one of them
};

/// Refuses normals whose cosine with a triangle is too small.
void SettledNormals::refuse() {
    for (const CornerNumbers& t : triangles_) {
        if (agrees_clearly(t)) continue;
        const FanTriangle seen = look_at(t);
        if (seen.area == 0) continue;
        for (const std::uint32_t v : t) {
            if (place_[v] != accepted) continue;
            if (dot(normals_[v], seen.direction) >= least_of_gradient) continue;
            place_[v] = static_cast<std::uint32_t>(refused_.size());
            refused_.push_back(v);
        }
    }
}

/// Calls function(place of a refused vertex, a triangle around it).
template <class Function>
void SettledNormals::for_each_of_fans(const Function& function) const {
    for (const CornerNumbers& t : triangles_) {
        if (std::ranges::all_of(t, [&](auto v) { return place_[v] == accepted; })) continue;
        const FanTriangle seen = look_at(t);
        if (seen.area == 0) continue;
        for (const std::uint32_t v : t) {
            if (place_[v] != accepted) function(place_[v], seen);
        }
    }
}

void SettledNormals::list_fans() {
    first_.assign(refused_.size() + 1, 0);
    for_each_of_fans([&](std::uint32_t i, const FanTriangle&) { ++first_[i + 1U]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    fans_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_each_of_fans([&](std::uint32_t i, const FanTriangle& t) { fans_[next[i]++] = t; });
}

/// Turns the normal of a refused vertex.
/// \return whether any direction agrees with all triangles around
bool SettledNormals::settle(std::size_t i) {
    fan_.clear();
    Point mean{0, 0, 0};
    const auto fan = std::span(fans_).subspan(first_[i], first_[i + 1] - first_[i]);
    // So that rounding does not depend on the order of the triangles.
    std::ranges::sort(fan, [](const FanTriangle& a, const FanTriangle& b) {
        return std::tie(a.direction, a.area) < std::tie(b.direction, b.area);
    });
    for (const FanTriangle& t : fan) {
        fan_.push_back(t.direction);
        mean = mean + t.area * t.direction;
    }
    const double length = norm(mean);
    if (length > 0) mean = (1 / length) * mean;

    Point& normal = normals_[refused_[i]];
    if (!(dot(normal, mean) >= least_with_mean)) normal = mean;
    Agreement target{mean, least_cosine(mean, fan_)};
    if (target.cosine < least_of_mean) target = widest_direction(fan_);
    if (target.cosine > 0) {
        const double least = std::min(least_of_gradient, target.cosine / 2);
        normal = first_agreeing(normal, target.direction, fan_, least);
        return true;
    }
    if (!(norm(normal) > 0)) normal = target.direction;
    return false;
}

}  // namespace

std::size_t settle_normals(std::span<const CornerNumbers> triangles, std::span<const Point> x,
                           std::span<Point> normals, double extent) {
    return SettledNormals(triangles, x, normals, extent).run();
}

double extent_of(std::span<const Point> x) {
    double extent = 0;
    for (const Point& at : x) extent = std::max(extent, norm(at));
    return extent;
}

}  // namespace engine

std::size_t settle_normals(Surface<3>& surface) {
    surface.normals.resize(surface.vertices.size(), Point{0, 0, 0});
    return engine::settle_normals(surface.simplices, surface.vertices, surface.normals,
                                  engine::extent_of(surface.vertices));
}

}  // namespace nestgrid
