// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A point lies inside an element where it lies behind every face, be a quadrilateral face cut along
// either diagonal. So no element is said to contain a point that it does not contain, also where
// faces are not plane.
#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <utility>

#include <nestgrid/detail/coarse_boundary.hpp>

#include "box_tree.hpp"

namespace nestgrid::detail {

namespace {

constexpr double margin = 1e-6;  // of the size of an element

/// A coarse element that is shown.
struct Body {
    std::size_t element = 0;
    Shape shape = Shape::point;
    double orientation = 1;  ///< in the plane: 1 where its loop is counterclockwise
    std::array<Point, max_corners> x{};
    double size = 0;

    std::span<const Point> points() const { return std::span(x).first(topology(shape).corners); }
    Point middle() const {
        Point sum{};
        for (const Point& corner : points()) sum = sum + corner;
        return (1.0 / static_cast<double>(points().size())) * sum;
    }
    /// The middle, and the points half-way between it and the corners.
    std::vector<Point> inner_points() const {
        std::vector<Point> inner{middle()};
        for (const Point& corner : points()) inner.push_back(0.5 * (inner[0] + corner));
        return inner;
    }
    bool contains(const Point& p) const;
};

/// Whether a point lies behind the plane of a triangle, or the line of a segment in the plane.
bool lies_behind(const Point& from, const Point& normal, const Point& p, double least) {
    return dot(normal, p - from) < -least * norm(normal);
}

bool Body::contains(const Point& p) const {
    const Topology& t = topology(shape);
    const double least = margin * size;
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        const auto at = [&](std::size_t k) { return x[face.corner[k % face.corners]]; };
        if (face.corners == 2) {
            const Point along = at(1) - at(0);
            const Point outwards = orientation * Point{along[1], -along[0], 0};
            if (!lies_behind(at(0), outwards, p, least)) return false;
            continue;
        }
        for (std::size_t k = 0; k < (face.corners == 4 ? 4U : 1U); ++k) {
            const Point normal = orientation * cross(at(k + 1) - at(k), at(k + 2) - at(k));
            if (!lies_behind(at(k), normal, p, least)) return false;
        }
    }
    return true;
}

template <class Real>
std::vector<Body> shown_bodies(const Hierarchy<Real>& hierarchy) {
    const std::unique_ptr<Task> task = hierarchy.open();
    std::vector<Body> bodies;
    Coarse coarse;
    Family family;
    for (std::size_t i = 0; i < hierarchy.coarse_count(); ++i) {
        hierarchy.coarse(task.get(), i, coarse, family);
        const bool is_masked = ((family.split | family.leaves) & 1U) == 0;
        if (is_masked || family.members[0].hidden != Hidden::not_at_all) continue;
        Body body{i, coarse.shape, static_cast<double>(coarse.orientation), coarse.corners};
        if (topology(body.shape).dimension == 2) {
            body.orientation = measure_vector(body.shape, body.points())[2] > 0 ? 1 : -1;
        }
        for (const Point& corner : body.points()) {
            body.size = std::max(body.size, 2 * norm(corner - body.middle()));
        }
        bodies.push_back(body);
    }
    return bodies;
}

/// Whether all bodies lie in a plane of one height.
bool lie_in_plane(std::span<const Body> bodies) {
    return std::ranges::all_of(bodies, [&](const Body& body) {
        return std::ranges::all_of(body.points(),
                                   [&](const Point& x) { return x[2] == bodies[0].x[0][2]; });
    });
}

}  // namespace

template <class Real>
std::vector<std::string> coarse_overlaps(const Hierarchy<Real>& hierarchy) {
    const int dimension = hierarchy.facts().dimension;
    const std::vector<Body> bodies = shown_bodies(hierarchy);
    if (dimension < 2 || (dimension == 2 && !lie_in_plane(bodies))) return {};
    std::vector<BoxTree::Box> boxes;
    for (const Body& body : bodies) boxes.push_back(BoxTree::around(body.points(), 0));
    BoxTree tree(boxes);
    std::vector<std::string> sentences;
    std::set<std::pair<std::size_t, std::size_t>> told;
    for (const Body& one : bodies) {
        const std::vector<Point> inner = one.inner_points();
        for (const std::size_t k : tree.near(BoxTree::around(inner, 0))) {
            const Body& other = bodies[k];
            if (other.element == one.element) continue;
            const auto common = std::ranges::find_if(
                inner, [&](const Point& p) { return other.contains(p) && one.contains(p); });
            if (common == inner.end()) continue;
            if (!told.insert(std::minmax(one.element, other.element)).second) continue;
            sentences.push_back("the coarse elements " + std::to_string(one.element) + " and " +
                                std::to_string(other.element) + " overlap: " + text_of(*common) +
                                " lies inside both");
        }
    }
    return sentences;
}

template std::vector<std::string> coarse_overlaps(const Hierarchy<float>&);
template std::vector<std::string> coarse_overlaps(const Hierarchy<double>&);

}  // namespace nestgrid::detail
