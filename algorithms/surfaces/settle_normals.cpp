// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/settle_normals.hpp>

#include <algorithm>
#include <vector>

#include <nestgrid/algorithms/normals.hpp>
#include <surfaces/widest_direction.hpp>

namespace nestgrid {

namespace engine {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr double least_of_gradient = 0.2;
constexpr double least_of_mean = 0.02;  // more than rounding to eight bits takes away

/// The first direction, on the way from one to another that agrees with all triangles of a fan,
/// that agrees with them, too. Along this way the product with each triangle is linear.
Point first_agreeing(const Point& from, const Agreement& to, std::span<const Point> fan) {
    const double least = std::min(least_of_mean, to.cosine / 2);
    double way = 0;
    for (const Point& triangle : fan) {
        const double before = dot(from, triangle);
        const double after = dot(to.direction, triangle);
        if (before < least) way = std::max(way, (least - before) / (after - before));
    }
    const Point direction = (1 - way) * from + way * to.direction;
    return (1 / norm(direction)) * direction;
}

class SettledNormals {
public:
    SettledNormals(std::span<const Triangle> triangles, std::span<const Point> x,
                   std::span<Point> normals)
        : triangles_{triangles}, x_{x}, normals_{normals}, refused_(normals.size(), 0) {}

    std::size_t run() {
        refuse(least_of_gradient, 0);
        if (!any_refused()) return 0;
        take_means();
        refuse(least_of_mean, 1);
        if (std::ranges::find(refused_, 2) == refused_.end()) return 0;
        list_fans();
        return take_widest();
    }

private:
    /// Twice the area vector.
    Point area(const Triangle& t) const { return cross(x_[t[1]] - x_[t[0]], x_[t[2]] - x_[t[0]]); }
    bool any_refused() const { return std::ranges::find(refused_, 1) != refused_.end(); }
    bool is_refused(const Triangle& t, std::uint8_t times) const {
        return refused_[t[0]] == times || refused_[t[1]] == times || refused_[t[2]] == times;
    }

    void refuse(double least, std::uint8_t times);
    void take_means();
    void list_fans();
    std::size_t take_widest();

    std::span<const Triangle> triangles_;
    std::span<const Point> x_;
    std::span<Point> normals_;
    std::vector<std::uint8_t> refused_;    // by vertex: how often its normal was refused
    std::vector<std::uint32_t> vertices_;  // refused twice
    std::vector<std::uint32_t> first_;     // of each of these: its first direction, and the end
    std::vector<Point> directions_;        // of the triangles around each of them
};

/// Refuses normals that were refused so many times, where the cosine with a triangle is less.
void SettledNormals::refuse(double least, std::uint8_t times) {
    for (const Triangle& t : triangles_) {
        if (times > 0 && !is_refused(t, times)) continue;
        const Point n = area(t);
        const double length = norm(n);
        if (length == 0) continue;
        for (const std::uint32_t v : t) {
            const bool agrees = dot(normals_[v], n) >= least * length;
            if (!agrees && refused_[v] == times) refused_[v] = static_cast<std::uint8_t>(times + 1);
        }
    }
}

/// Replaces refused normals by the means of the triangles around.
void SettledNormals::take_means() {
    for (std::size_t v = 0; v < normals_.size(); ++v) {
        if (refused_[v] != 0) normals_[v] = {0, 0, 0};
    }
    for (const Triangle& t : triangles_) {
        if (!is_refused(t, 1)) continue;
        const Point n = area(t);
        for (const std::uint32_t v : t) {
            if (refused_[v] != 0) normals_[v] = normals_[v] + n;
        }
    }
    for (std::size_t v = 0; v < normals_.size(); ++v) {
        const double length = refused_[v] == 0 ? 0 : norm(normals_[v]);
        if (length > 0) normals_[v] = (1 / length) * normals_[v];
    }
}

/// Lists the directions of the triangles around vertices whose normals were refused twice.
void SettledNormals::list_fans() {
    std::vector<std::uint32_t> place(normals_.size(), 0);  // of a vertex in vertices_
    for (std::uint32_t v = 0; v < normals_.size(); ++v) {
        if (refused_[v] != 2) continue;
        place[v] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(v);
    }
    const auto for_each = [&](auto&& function) {
        for (const Triangle& t : triangles_) {
            if (!is_refused(t, 2)) continue;
            const Point n = area(t);
            const double length = norm(n);
            if (length == 0) continue;
            for (const std::uint32_t v : t) {
                if (refused_[v] == 2) function(place[v], (1 / length) * n);
            }
        }
    };
    first_.assign(vertices_.size() + 1, 0);
    for_each([&](std::uint32_t at, const Point&) { ++first_[at + 1U]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    directions_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for_each([&](std::uint32_t at, const Point& n) { directions_[next[at]++] = n; });
}

/// \return the number of vertices at which no direction agrees with all triangles
std::size_t SettledNormals::take_widest() {
    std::size_t folded = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
        const auto fan =
            std::span<const Point>(directions_).subspan(first_[i], first_[i + 1] - first_[i]);
        const Agreement widest = widest_direction(fan);
        Point& normal = normals_[vertices_[i]];
        if (widest.cosine > 0) {
            normal = first_agreeing(normal, widest, fan);
            continue;
        }
        ++folded;
        if (!(norm(normal) > 0)) normal = widest.direction;
    }
    return folded;
}

}  // namespace

std::size_t settle_normals(std::span<const Triangle> triangles, std::span<const Point> x,
                           std::span<Point> normals) {
    return SettledNormals(triangles, x, normals).run();
}

}  // namespace engine

std::size_t settle_normals(Surface<3>& surface) {
    surface.normals.resize(surface.vertices.size(), Point{0, 0, 0});
    return engine::settle_normals(surface.simplices, surface.vertices, surface.normals);
}

}  // namespace nestgrid
