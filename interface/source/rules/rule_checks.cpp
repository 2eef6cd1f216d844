// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The checks of a rule: find_violation().
#include <algorithm>
#include <cmath>
#include <map>

#include <nestgrid/rule.hpp>

#include "derived_members.hpp"

namespace nestgrid {

namespace detail {

double signed_reference_measure(Shape shape, std::span<const Point> x) {
    const Point v = measure_vector(shape, x);
    return topology(shape).dimension == 1 ? v[0] : v[2];
}

std::vector<unsigned> face_incidence(const Rule& rule) {
    const Topology& t = topology(rule.parent);
    std::vector<unsigned> faces(t.corners, 0);
    for (std::size_t f = 0; f < t.faces; ++f) {
        for (std::size_t i = 0; i < t.face[f].corners; ++i) faces[t.face[f].corner[i]] |= 1U << f;
    }
    for (const Stencil& s : rule.new_nodes) {
        unsigned common = ~0U;
        for (std::size_t i = 0; i < s.count; ++i) common &= faces[s.parent[i]];
        faces.push_back(common);
    }
    return faces;
}

}  // namespace detail

namespace {

constexpr double rule_tolerance = 1e-9;

bool inside_reference(Shape shape, const Point& x) {
    const double e = rule_tolerance;
    if (std::min({x[0], x[1], x[2]}) < -e) return false;
    switch (shape) {
        case Shape::triangle:
        case Shape::tetrahedron:
            return x[0] + x[1] + x[2] <= 1 + e;
        case Shape::pyramid:
            return std::max(x[0], x[1]) + x[2] <= 1 + e;
        case Shape::prism:
            return x[0] + x[1] <= 1 + e && x[2] <= 1 + e;
        default:
            return std::max({x[0], x[1], x[2]}) <= 1 + e;
    }
}

std::string node_name(const Rule& rule, std::size_t node) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    return node < corners ? "corner " + std::to_string(node)
                          : "new node " + std::to_string(node - corners);
}

std::optional<std::string> find_stencil_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        const Stencil& s = rule.new_nodes[n];
        const std::string who = name + "new node " + std::to_string(n);
        if (s.count < 2 || s.count > max_corners) return who + " needs 2 to 8 parents";
        double sum = 0;
        for (std::size_t i = 0; i < s.count; ++i) {
            if (s.parent[i] >= corners + n) return who + " names a node that comes later";
            for (std::size_t j = 0; j < i; ++j) {
                if (s.parent[i] == s.parent[j]) return who + " names one parent twice";
            }
            if (!(s.weight[i] > 0)) return who + " has a weight that is not positive";
            sum += s.weight[i];
        }
        if (!(std::abs(sum - 1) < 1e-12)) {
            return who + " has weights that add up to " + std::to_string(sum) + ", not to 1";
        }
    }
    return std::nullopt;
}

std::optional<std::string> find_child_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    const std::vector<Point> nodes = reference_nodes(rule);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& child = rule.children[c];
        const std::string who = name + "child " + std::to_string(c);
        const Topology& t = topology(child.shape);
        if (t.dimension != topology(rule.parent).dimension) return who + " has another dimension";
        if (child.orientation != 1 && child.orientation != -1) {
            return who + " has an orientation that is neither 1 nor -1";
        }
        std::vector<Point> x(t.corners);
        for (std::size_t i = 0; i < t.corners; ++i) {
            if (child.corner[i] >= nodes.size()) return who + " has a corner that is no node";
            x[i] = nodes[child.corner[i]];
            if (!inside_reference(rule.parent, x[i])) {
                return who + " lies outside its father at " + node_name(rule, child.corner[i]);
            }
        }
        const auto is_new = [&](std::uint8_t node) { return node >= rule.corner_count(); };
        if (!rule.new_nodes.empty() &&
            std::none_of(child.corner.begin(), child.corner.begin() + t.corners, is_new)) {
            return who + " has no new node for a corner";
        }
        const double volume = detail::signed_reference_measure(child.shape, x);
        if (!(child.orientation * volume > rule_tolerance)) {
            return who + " is inverted or flat under its orientation sign";
        }
    }
    return std::nullopt;
}

/// Whether a loop of corners runs upwards after its least one: its sense, whatever its start.
bool runs_upwards(std::span<const std::uint8_t> loop) {
    const auto least =
        static_cast<std::size_t>(std::min_element(loop.begin(), loop.end()) - loop.begin());
    const std::size_t n = loop.size();
    return n == 2 ? least == 0 : loop[(least + 1) % n] < loop[(least + n - 1) % n];
}

/// Faces of children that lie in no face of the parent, by their sorted corners; how many children
/// see each from either side.
using InnerFaces = std::map<std::array<std::uint8_t, 4>, std::array<int, 2>>;

InnerFaces inner_faces(const Rule& rule) {
    const std::vector<unsigned> incidence = detail::face_incidence(rule);
    InnerFaces uses;
    for (const Child& child : rule.children) {
        const Topology& t = topology(child.shape);
        for (std::size_t f = 0; f < t.faces; ++f) {
            std::array<std::uint8_t, 4> face;
            face.fill(no_face);
            unsigned common = ~0U;
            for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                face[i] = child.corner[t.face[f].corner[i]];
                common &= incidence[face[i]];
            }
            const bool up =
                t.dimension == 1 ? f == 1 : runs_upwards(std::span(face).first(t.face[f].corners));
            std::sort(face.begin(), face.end());
            if (common == 0) ++uses[face][up == (child.orientation > 0) ? 1 : 0];
        }
    }
    return uses;
}

/// Finds children whose volumes do not add up, and inner faces that do not belong to two children,
/// one on each side.
std::optional<std::string> find_tiling_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    const std::vector<Point> nodes = reference_nodes(rule);
    double volume = 0;
    for (const Child& child : rule.children) {
        std::vector<Point> x(topology(child.shape).corners);
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = nodes[child.corner[i]];
        volume += child.orientation * detail::signed_reference_measure(child.shape, x);
    }
    const double parent = detail::signed_reference_measure(
        rule.parent, std::span(nodes).first(static_cast<std::size_t>(rule.corner_count())));
    if (!(std::abs(volume - parent) < rule_tolerance)) {
        return name + "volume lost: the children hold " + std::to_string(volume / parent) +
               " of their father";
    }
    for (const auto& [face, sides] : inner_faces(rule)) {
        if (sides[0] != 1 || sides[1] != 1) {
            return name + "an inner face belongs to " + std::to_string(sides[0]) + " and " +
                   std::to_string(sides[1]) + " children on its two sides, not to one on each";
        }
    }
    return std::nullopt;
}

/// Says the way out, too: 4 x 4 x 4 parts are 2 x 2 x 2 parts twice.
std::string too_many(std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what +
           ", more than 64: refine in several steps, each by a rule of its own, by fewer parts or "
           "along one axis after the other";
}

}  // namespace

std::optional<std::string> find_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    if (rule.parent == Shape::point) return name + "a point has no children";
    if (rule.children.empty()) return name + "there are no children";
    if (rule.children.size() > max_children)
        return name + too_many(rule.children.size(), "children");
    if (rule.new_nodes.size() > max_new_nodes) {
        return name + too_many(rule.new_nodes.size(), "new nodes");
    }
    if (auto v = find_stencil_violation(rule)) return v;
    if (auto v = find_child_violation(rule)) return v;
    return find_tiling_violation(rule);
}

}  // namespace nestgrid
