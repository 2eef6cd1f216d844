// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/support.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <surfaces/triangle_sides.hpp>

namespace nestgrid::engine {

namespace {

constexpr double support_rounding = 1e-10;  // of the surface's extent, by which a plane may be left
constexpr double fold = 1e-6;               // sine of the angle between faces that is about 0
constexpr std::uint32_t no_face = ~std::uint32_t{0};

/// Finds faces and borders. Both grow from their largest triangle, or longest edge, so that their
/// planes are known as well as possible.
class SupportSearch {
public:
    explicit SupportSearch(const Surface<3>& surface)
        : surface_{surface}, freedom_(surface.vertices.size()) {
        slack_ = support_rounding * Box::around(surface.vertices).diameter();
        look_at_edges();
        find_faces();
        for (std::size_t t = 0; t < surface.simplices.size(); ++t) {
            for (const std::uint32_t v : surface.simplices[t]) {
                freedom_[v].add(planes_[face_[t]]);
            }
        }
        find_folds();
        find_borders();
    }
    std::vector<Freedom> take() { return std::move(freedom_); }

private:
    using Corners = std::array<std::uint32_t, 3>;
    /// An edge that faces end at, or a fold.
    struct Border {
        std::uint32_t a;
        std::uint32_t b;
        std::uint32_t triangle;
        double length;
        bool done = false;
    };
    struct Pair {
        OrientedSide first;
        OrientedSide second;
    };

    const Point& x(std::uint32_t v) const { return surface_.vertices[v]; }
    Point normal(std::size_t t) const {
        const Corners& c = surface_.simplices[t];
        return cross(x(c[1]) - x(c[0]), x(c[2]) - x(c[0]));
    }
    void add_border(const OrientedSide& side) {
        borders_.push_back({side.low, side.high, side.triangle, norm(x(side.high) - x(side.low))});
    }

    void look_at_edges() {
        for_each_edge(sorted_sides(surface_.simplices), [&](std::span<const OrientedSide> edge) {
            if (edge.size() == 1) return add_border(edge[0]);
            if (edge.size() == 2 && edge[0].forward != edge[1].forward) {
                return pairs_.push_back({edge[0], edge[1]});
            }
            freedom_[edge[0].low].fasten();
            freedom_[edge[0].high].fasten();
        });
    }

    void find_faces() {
        const std::size_t count = surface_.simplices.size();
        std::vector<std::array<std::uint32_t, 3>> beside(count, {no_face, no_face, no_face});
        const auto join = [&](std::uint32_t t, std::uint32_t to) {
            *std::find(beside[t].begin(), beside[t].end(), no_face) = to;
        };
        for (const Pair& pair : pairs_) {
            join(pair.first.triangle, pair.second.triangle);
            join(pair.second.triangle, pair.first.triangle);
        }
        std::vector<double> area(count);
        for (std::size_t t = 0; t < count; ++t) area[t] = norm(normal(t));
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return area[a] > area[b]; });
        face_.assign(count, no_face);
        std::vector<std::uint32_t> open;
        for (const std::uint32_t seed : order) {
            if (face_[seed] != no_face) continue;
            const auto face = static_cast<std::uint32_t>(planes_.size());
            const Point direction = (1 / area[seed]) * normal(seed);
            planes_.push_back({direction, dot(direction, x(surface_.simplices[seed][0])), slack_});
            const auto lies_in = [&](std::uint32_t t) {
                const Corners& c = surface_.simplices[t];
                return dot(normal(t), direction) >= 0 &&
                       std::all_of(c.begin(), c.end(), [&](std::uint32_t v) {
                           return std::abs(dot(direction, x(v)) - planes_[face].level) <= slack_;
                       });
            };
            face_[seed] = face;
            open.assign(1, seed);
            while (!open.empty()) {
                const std::uint32_t t = open.back();
                open.pop_back();
                for (const std::uint32_t other : beside[t]) {
                    if (other == no_face || face_[other] != no_face || !lies_in(other)) continue;
                    face_[other] = face;
                    open.push_back(other);
                }
            }
        }
    }

    /// Two faces back to back have the same plane, which does not keep the edge between them.
    void find_folds() {
        for (const Pair& pair : pairs_) {
            const std::uint32_t f = face_[pair.first.triangle];
            const std::uint32_t g = face_[pair.second.triangle];
            if (f != g && !(norm(cross(planes_[f].normal, planes_[g].normal)) > fold)) {
                add_border(pair.first);
            }
        }
    }

    void find_borders() {
        std::stable_sort(borders_.begin(), borders_.end(),
                         [](const Border& a, const Border& b) { return a.length > b.length; });
        std::vector<std::vector<std::uint32_t>> at(surface_.vertices.size());
        for (std::uint32_t i = 0; i < borders_.size(); ++i) {
            at[borders_[i].a].push_back(i);
            at[borders_[i].b].push_back(i);
        }
        std::vector<std::uint32_t> open;
        for (std::uint32_t seed = 0; seed < borders_.size(); ++seed) {
            if (borders_[seed].done) continue;
            const Border& first = borders_[seed];
            const std::uint32_t face = face_[first.triangle];
            const Point along = (1 / first.length) * (x(first.b) - x(first.a));
            const Point across = cross(planes_[face].normal, along);
            const Point normal = (1 / norm(across)) * across;
            const BorderPlane plane{normal, dot(normal, x(first.a)), slack_};
            open.assign(1, seed);
            borders_[seed].done = true;
            while (!open.empty()) {
                const Border& border = borders_[open.back()];
                open.pop_back();
                for (const std::uint32_t v : {border.a, border.b}) {
                    freedom_[v].add(plane);
                    for (const std::uint32_t next : at[v]) {
                        Border& other = borders_[next];
                        const std::uint32_t end = other.a == v ? other.b : other.a;
                        const double off = dot(normal, x(end)) - plane.level;
                        if (other.done || face_[other.triangle] != face ||
                            !(std::abs(off) <= slack_)) {
                            continue;
                        }
                        other.done = true;
                        open.push_back(next);
                    }
                }
            }
        }
    }

    const Surface<3>& surface_;
    double slack_ = 0;
    std::vector<Freedom> freedom_;
    std::vector<Pair> pairs_;  // of sides, on edges between two triangles
    std::vector<Border> borders_;
    std::vector<std::uint32_t> face_;  // by triangle
    std::vector<BorderPlane> planes_;  // by face
};

}  // namespace

std::vector<Freedom> support_freedom(const Surface<3>& surface) {
    return SupportSearch(surface).take();
}

}  // namespace nestgrid::engine
