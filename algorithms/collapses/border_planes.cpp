// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <collapses/border_planes.hpp>

#include <algorithm>

#include <collapses/affine_leaf.hpp>

namespace nestgrid::engine {

namespace {

constexpr double plane_rounding = 1e-9;  // of directions of planes, and of distances in leaves

}  // namespace

/// Whether a plane through the vertex is one of its planes.
bool Freedom::has_direction(const BorderPlane& plane) const {
    for (std::size_t i = 0; i < std::min<std::size_t>(count_, 3); ++i) {
        if (norm(cross(plane_[i].normal, plane.normal)) < plane_rounding) return true;
    }
    return false;
}

bool Freedom::has(const BorderPlane& plane) const {
    for (std::size_t i = 0; i < std::min<std::size_t>(count_, 3); ++i) {
        const BorderPlane& own = plane_[i];
        const double level = dot(own.normal, plane.normal) > 0 ? own.level : -own.level;
        if (norm(cross(own.normal, plane.normal)) < plane_rounding &&
            std::abs(level - plane.level) <= own.slack + plane.slack) {
            return true;
        }
    }
    return false;
}

void Freedom::add(const BorderPlane& plane) {
    if (count_ == fast_ || has_direction(plane)) return;
    if (count_ == 3)
        count_ = fast_;
    else
        plane_[count_++] = plane;
}

bool Freedom::keeps(const Freedom& other) const {
    if (other.count_ == 0) return true;
    if (other.count_ == fast_ || count_ == fast_) return false;
    return std::all_of(other.plane_.begin(), other.plane_.begin() + other.count_,
                       [this](const BorderPlane& plane) { return has(plane); });
}

bool Freedom::may_share_plane(const Freedom& a, const Freedom& b, const Freedom& c) {
    if (a.count_ == 0 || b.count_ == 0 || c.count_ == 0) return false;
    if (a.count_ == fast_ || b.count_ == fast_ || c.count_ == fast_) return true;
    return std::any_of(a.plane_.begin(), a.plane_.begin() + a.count_,
                       [&](const BorderPlane& plane) { return b.has(plane) && c.has(plane); });
}

std::size_t Freedom::directions(std::array<Point, 3>& out) const {
    if (count_ == 0) {
        out = {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
        return 3;
    }
    if (count_ > 2) return 0;
    const Point& n = plane_[0].normal;
    if (count_ == 2) {
        const Point along = cross(n, plane_[1].normal);
        out[0] = (1 / norm(along)) * along;
        return 1;
    }
    std::size_t least = 0;
    for (const std::size_t d : {1U, 2U}) {
        if (std::abs(n[d]) < std::abs(n[least])) least = d;
    }
    Point axis{0, 0, 0};
    axis[least] = 1;
    const Point along = cross(n, axis);
    out[0] = (1 / norm(along)) * along;
    out[1] = cross(n, out[0]);
    return 2;
}

Freedom border_freedom(const NearLeaves& leaves, const Point& x) {
    Freedom freedom;
    const Box at{x, x};
    leaves.for_each(
        [&](const Box& box) {
            Box wide = box;
            wide.widen(plane_rounding * box.diameter());
            return wide.meets(at);
        },
        [&](const NearLeaf& leaf) {
            if (leaf.boundary == 0) return true;
            std::array<Point, max_corners> room;
            const auto corners = leaves.corners(leaf, room);
            Box box = Box::around(corners);
            box.widen(plane_rounding * box.diameter());
            if (!box.contains(x)) return true;
            if (!leaf.affine) {
                freedom.fasten();
                return false;
            }
            const AffineLeaf map(leaf.shape, corners);
            const auto distance = face_distances(leaf.shape, map.reference(x));
            const std::size_t faces = topology(leaf.shape).faces;
            for (std::size_t f = 0; f < faces; ++f) {
                if (distance[f] < -plane_rounding) return true;
            }
            for (std::size_t f = 0; f < faces; ++f) {
                if ((leaf.boundary >> f & 1U) == 0 || distance[f] > plane_rounding) continue;
                const Point direction = map.face_direction(leaf.shape, f);
                const Point normal = (1 / norm(direction)) * direction;
                freedom.add(
                    {normal, dot(normal, x), plane_rounding * (box.diameter() + 1e-6 * norm(x))});
            }
            return true;
        });
    if (freedom.free()) freedom.fasten();
    return freedom;
}

}  // namespace nestgrid::engine
