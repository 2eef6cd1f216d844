// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements that do not overlap touch where faces are that no ids join. So the nodes and the edges
// of these faces are looked at, and nothing else.
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <nestgrid/detail/coarse_boundary.hpp>

#include "box_tree.hpp"

namespace nestgrid::detail {

namespace {

constexpr double closeness = 1e-6;  // of the size of a face or edge

/// A part of the boundary of coarse elements: a node, an edge or a face, with its corners in a
/// loop.
struct Part {
    std::uint8_t corners = 0;
    std::array<std::uint64_t, 4> id{};
    std::array<Point, 4> x{};
    std::vector<std::size_t> elements;  // that have it
    std::uint8_t face = 0;              // number in the first of them, of a face

    std::span<const Point> points() const { return std::span(x).first(corners); }
    bool has(std::uint64_t node) const {
        return std::find(id.begin(), id.begin() + corners, node) != id.begin() + corners;
    }
    double size() const {
        double greatest = 0;
        for (std::size_t k = 0; k < corners; ++k) {
            for (std::size_t l = 0; l < k; ++l) greatest = std::max(greatest, norm(x[k] - x[l]));
        }
        return greatest;
    }
};

/// Unites the parts that have the same ids in the same order.
std::vector<Part> united(std::vector<Part> parts) {
    std::ranges::stable_sort(parts, {}, &Part::id);
    std::vector<Part> result;
    for (Part& part : parts) {
        if (!result.empty() && result.back().id == part.id) {
            result.back().elements.push_back(part.elements.front());
        } else {
            result.push_back(std::move(part));
        }
    }
    return result;
}

/// The single faces of elements that are shown, their edges and their nodes.
struct Boundary {
    std::vector<Part> nodes;
    std::vector<Part> edges;  // in three dimensions; in two these are the faces
    std::vector<Part> faces;

    template <class Real>
    Boundary(const Hierarchy<Real>& hierarchy, std::span<const std::uint8_t> single) {
        const std::unique_ptr<Task> task = hierarchy.open();
        Coarse coarse;
        Family family;
        for (std::size_t i = 0; i < single.size(); ++i) {
            if (single[i] == 0) continue;
            hierarchy.coarse(task.get(), i, coarse, family);
            const bool is_masked = ((family.split | family.leaves) & 1U) == 0;
            if (is_masked || family.members[0].hidden == Hidden::wholly) continue;
            for (std::uint8_t f = 0; f < topology(coarse.shape).faces; ++f) {
                if ((single[i] >> f & 1U) != 0) add_face(coarse, i, f);
            }
        }
        nodes = united(std::move(nodes));
        edges = united(std::move(edges));
    }

private:
    void add_face(const Coarse& coarse, std::size_t i, std::uint8_t f) {
        const FaceTopology& face = topology(coarse.shape).face[f];
        if (face.corners < 2) return;
        faces.push_back(part(coarse, i, std::span(face.corner).first(face.corners)));
        faces.back().face = f;
        for (std::size_t k = 0; k < face.corners; ++k) {
            nodes.push_back(part(coarse, i, std::array{face.corner[k]}));
            if (face.corners == 2) continue;
            std::array edge{face.corner[k], face.corner[(k + 1) % face.corners]};
            if (coarse.ids[edge[1]] < coarse.ids[edge[0]]) std::swap(edge[0], edge[1]);
            edges.push_back(part(coarse, i, edge));
        }
    }
    static Part part(const Coarse& coarse, std::size_t i, std::span<const std::uint8_t> corners) {
        Part part;
        part.elements = {i};
        for (const std::uint8_t corner : corners) {
            part.id[part.corners] = coarse.ids[corner];
            part.x[part.corners++] = coarse.corners[corner];
        }
        return part;
    }
};

/// Whether a point lies on an edge, away from its ends.
bool lies_on_edge(const Part& edge, const Point& x, double near) {
    const Point along = edge.x[1] - edge.x[0];
    const double at = dot(x - edge.x[0], along) / dot(along, along);
    return at > 0 && at < 1 && norm(x - edge.x[0] - at * along) <= near;
}

/// Whether a point lies on a triangle or a bilinear quadrilateral. The nearest point
/// x0 + r a + s b + r s c is found by Gauss and Newton.
bool lies_on_polygon(const Part& face, const Point& x, double near) {
    const bool is_triangle = face.corners == 3;
    const Point a = face.x[1] - face.x[0];
    const Point b = face.x[face.corners - 1U] - face.x[0];
    const Point c = is_triangle ? Point{} : face.x[2] - face.x[1] - b;
    double r = 1.0 / 3;
    double s = 1.0 / 3;
    Point off{};
    for (int i = 0; i < 10; ++i) {
        const Point u = a + s * c;
        const Point v = b + r * c;
        off = x - face.x[0] - r * a - s * v;
        const double det = dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v);
        if (!(det > 0)) return false;
        const double dr = (dot(off, u) * dot(v, v) - dot(off, v) * dot(u, v)) / det;
        const double ds = (dot(off, v) * dot(u, u) - dot(off, u) * dot(u, v)) / det;
        r = std::clamp(r + dr, -1.0, 2.0);
        s = std::clamp(s + ds, -1.0, 2.0);
        off = x - face.x[0] - r * a - s * (b + r * c);
    }
    const double most = 1 + closeness;
    return norm(off) <= near && r >= -closeness && s >= -closeness &&
           (is_triangle ? r + s <= most : r <= most && s <= most);
}

/// Whether a point lies on a face, and not at a corner of it.
bool lies_on(const Part& face, const Point& x) {
    const double near = closeness * face.size();
    for (const Point& corner : face.points()) {
        if (norm(x - corner) <= near) return false;
    }
    return face.corners == 2 ? lies_on_edge(face, x, near) : lies_on_polygon(face, x, near);
}

/// Where two edges cross, away from their ends.
std::optional<Point> crossing(const Part& one, const Part& other) {
    const Point u = one.x[1] - one.x[0];
    const Point v = other.x[1] - other.x[0];
    const Point between = other.x[0] - one.x[0];
    const double det = dot(u, u) * dot(v, v) - dot(u, v) * dot(u, v);
    if (!(det > closeness * dot(u, u) * dot(v, v))) return std::nullopt;  // about parallel
    const double s = (dot(between, u) * dot(v, v) - dot(between, v) * dot(u, v)) / det;
    const double t = (dot(between, u) * dot(u, v) - dot(between, v) * dot(u, u)) / det;
    constexpr double end = 10 * closeness;
    if (std::min(s, t) < end || std::max(s, t) > 1 - end) return std::nullopt;
    const Point at = one.x[0] + s * u;
    if (norm(other.x[0] + t * v - at) > closeness * std::min(norm(u), norm(v))) return std::nullopt;
    return at;
}

using Pair = std::pair<std::size_t, std::size_t>;

/// The elements that have parts of faces in common.
class Touching {
public:
    explicit Touching(std::span<const FaceContact> contacts) {
        for (const FaceContact& c : contacts)
            pairs_.insert(std::minmax(c.element[0], c.element[1]));
    }
    /// Whether elements of two parts are in contact, or one element has both.
    bool any(const Part& one, const Part& other) const {
        for (const std::size_t i : one.elements) {
            for (const std::size_t k : other.elements) {
                if (i == k || pairs_.contains(std::minmax(i, k))) return true;
            }
        }
        return false;
    }

private:
    std::set<Pair> pairs_;
};

std::string element_text(const Part& part) {
    return " of coarse element " + std::to_string(part.elements.front());
}

std::string node_text(const Part& node, const Part& face) {
    return "node " + std::to_string(node.id[0]) + element_text(node) + ", at " +
           text_of(node.x[0]) + ", lies on face " + std::to_string(face.face) + element_text(face) +
           ", which does not have it: they touch and share no node there";
}

std::string edge_text(const Part& one, const Part& other, const Point& at) {
    const auto edge = [](const Part& part) {
        return "the edge " + std::to_string(part.id[0]) + "-" + std::to_string(part.id[1]) +
               element_text(part);
    };
    return edge(one) + " and " + edge(other) + " cross at " + text_of(at) +
           ": they touch and share no node there";
}

std::vector<BoxTree::Box> boxes_around(std::span<const Part> parts) {
    std::vector<BoxTree::Box> boxes;
    for (const Part& part : parts) {
        boxes.push_back(BoxTree::around(part.points(), closeness * part.size()));
    }
    return boxes;
}

}  // namespace

template <class Real>
std::vector<std::string> point_contacts(const Hierarchy<Real>& hierarchy,
                                        std::span<const std::uint8_t> faces,
                                        std::span<const FaceContact> contacts) {
    const Boundary boundary(hierarchy, faces);
    const Touching touching(contacts);
    std::vector<std::string> sentences;
    BoxTree face_tree(boxes_around(boundary.faces));
    for (const Part& node : boundary.nodes) {
        for (const std::size_t k : face_tree.near(BoxTree::around(node.points(), 0))) {
            const Part& face = boundary.faces[k];
            if (face.has(node.id[0]) || !lies_on(face, node.x[0])) continue;
            if (!touching.any(node, face)) sentences.push_back(node_text(node, face));
        }
    }
    const auto boxes = boxes_around(boundary.edges);
    BoxTree edge_tree(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Part& one = boundary.edges[i];
        for (const std::size_t k : edge_tree.near(boxes[i])) {
            const Part& other = boundary.edges[k];
            if (k <= i || other.has(one.id[0]) || other.has(one.id[1])) continue;
            const auto at = crossing(one, other);
            if (at && !touching.any(one, other)) sentences.push_back(edge_text(one, other, *at));
        }
    }
    return sentences;
}

template std::vector<std::string> point_contacts(const Hierarchy<float>&,
                                                 std::span<const std::uint8_t>,
                                                 std::span<const FaceContact>);
template std::vector<std::string> point_contacts(const Hierarchy<double>&,
                                                 std::span<const std::uint8_t>,
                                                 std::span<const FaceContact>);

}  // namespace nestgrid::detail
