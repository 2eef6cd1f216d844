// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/collinear_triangles.hpp>

#include <algorithm>
#include <queue>
#include <unordered_map>

#include <nestgrid/detail/geometry.hpp>

namespace nestgrid::engine {

namespace {

using Vertex = std::uint32_t;
constexpr Vertex removed = ~Vertex{0};

class CollinearTriangles {
public:
    CollinearTriangles(std::vector<NumberedTriangle>& triangles,
                       const std::function<Point(Vertex)>& at,
                       const std::function<bool(Vertex)>& candidate)
        : triangles_{triangles}, at_{at}, candidate_{candidate} {}

    void remove() {
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) queue_if_collinear(t);
        if (queue_.empty()) return;
        for (std::uint32_t t = 0; t < triangles_.size(); ++t) index(t);
        // Flips of the longest sides end by themselves; rounding could only prolong them.
        std::size_t flips_left = 16 * triangles_.size();
        while (!queue_.empty() && flips_left-- > 0) {
            const Queued next = queue_.top();
            queue_.pop();
            if (triangles_[next.triangle] == next.as) flip(next.triangle);
        }
        std::erase_if(triangles_, [](const NumberedTriangle& t) { return t.v[0] == removed; });
        std::ranges::stable_sort(triangles_, {}, &NumberedTriangle::from);
    }

private:
    struct Queued {
        double longest;
        std::uint32_t triangle;
        NumberedTriangle as;  // to find out whether it has changed since
    };
    /// Of two triangles, the one with the longer side comes first; of equal ones, that at the
    /// lesser place, so that the order does not depend on the numbers of triangles.
    struct ComesLater {
        const CollinearTriangles* all;
        bool operator()(const Queued& a, const Queued& b) const {
            if (a.longest != b.longest) return a.longest < b.longest;
            for (std::size_t i = 0; i < 3; ++i) {
                const Point& x = all->at_(a.as.v[i]);
                const Point& y = all->at_(b.as.v[i]);
                if (x != y) return y < x;
            }
            return a.triangle > b.triangle;
        }
    };

    double length(Vertex a, Vertex b) const { return norm(at_(b) - at_(a)); }

    /// Turns the triangle so that its longest side comes first. \return the length of that side
    double turn(std::array<Vertex, 3>& v) const {
        const std::array<double, 3> side{length(v[0], v[1]), length(v[1], v[2]),
                                         length(v[2], v[0])};
        const auto first = std::ranges::max_element(side) - side.begin();
        std::rotate(v.begin(), v.begin() + first, v.end());
        return side[static_cast<std::size_t>(first)];
    }

    /// Whether the height is next to nothing, and no side is: a flip of a triangle with two
    /// vertices at one place would turn around that place for ever.
    bool is_collinear(std::uint32_t t) const {
        const auto& v = triangles_[t].v;
        if (!std::ranges::all_of(v, candidate_)) return false;
        const std::array<double, 3> side{length(v[0], v[1]), length(v[1], v[2]),
                                         length(v[2], v[0])};
        const auto [shortest, longest] = std::ranges::minmax(side);
        return shortest > 1e-9 * longest && are_collinear(at_(v[0]), at_(v[1]), at_(v[2]));
    }

    void queue_if_collinear(std::uint32_t t) {
        if (!is_collinear(t)) return;
        const double longest = turn(triangles_[t].v);
        queue_.push({longest, t, triangles_[t]});
    }

    static std::uint64_t name(Vertex a, Vertex b) { return std::uint64_t{a} << 32U | b; }

    template <class Function>
    void for_each_side(std::uint32_t t, Function&& function) {
        const auto& v = triangles_[t].v;
        for (std::size_t i = 0; i < 3; ++i) function(v[i], v[(i + 1) % 3]);
    }
    void index(std::uint32_t t) {
        for_each_side(t, [&](Vertex a, Vertex b) {
            if (candidate_(a) && candidate_(b)) with_side_.emplace(name(a, b), t);
        });
    }
    void forget(std::uint32_t t) {
        for_each_side(t, [&](Vertex a, Vertex b) {
            const auto [first, last] = with_side_.equal_range(name(a, b));
            const auto found = std::find_if(first, last, [&](auto& e) { return e.second == t; });
            if (found != last) with_side_.erase(found);
        });
    }
    void set(std::uint32_t t, const NumberedTriangle& as) {
        triangles_[t] = as;
        index(t);
        queue_if_collinear(t);
    }

    static Vertex third(const std::array<Vertex, 3>& v, Vertex a, Vertex b) {
        return v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
    }
    /// The triangle beyond a side, or `removed`. Of several, the one whose third vertex lies at the
    /// least place.
    std::uint32_t beyond(Vertex a, Vertex b) const {
        const auto [first, last] = with_side_.equal_range(name(b, a));
        if (first == last) return removed;
        const auto far = [&](const auto& e) { return at_(third(triangles_[e.second].v, a, b)); };
        return std::min_element(first, last,
                                [&](const auto& x, const auto& y) { return far(x) < far(y); })
            ->second;
    }

    /// Flips the longest side of a collinear triangle, or removes the triangle where nothing lies
    /// beyond that side, or only the same triangle turned over.
    void flip(std::uint32_t t) {
        const auto [a, b, middle] = triangles_[t].v;
        const std::uint32_t other = beyond(a, b);
        forget(t);
        triangles_[t].v[0] = removed;
        if (other == removed) return;
        forget(other);
        const auto [v, from] = triangles_[other];
        const Vertex far = third(v, a, b);
        triangles_[other].v[0] = removed;
        if (far == middle) return;
        set(t, {{a, far, middle}, from});
        set(other, {{far, b, middle}, from});
    }

    std::vector<NumberedTriangle>& triangles_;
    const std::function<Point(Vertex)>& at_;
    const std::function<bool(Vertex)>& candidate_;
    std::priority_queue<Queued, std::vector<Queued>, ComesLater> queue_{ComesLater{this}};
    std::unordered_multimap<std::uint64_t, std::uint32_t> with_side_;  // by directed side
};

}  // namespace

bool are_collinear(const Point& a, const Point& b, const Point& c) {
    const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
    return norm(cross(b - a, c - a)) <= 1e-9 * longest * longest;
}

void remove_collinear(std::vector<NumberedTriangle>& triangles,
                      const std::function<Point(std::uint32_t)>& at,
                      const std::function<bool(std::uint32_t)>& candidate) {
    CollinearTriangles(triangles, at, candidate).remove();
}

}  // namespace nestgrid::engine
