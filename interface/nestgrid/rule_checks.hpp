// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Building and checking refinement rules; included by rule.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>

#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

namespace detail {

inline constexpr double rule_tolerance = 1e-9;

void find_parts(Rule& rule);      // rule_parts.hpp
void place_in_parts(Rule& rule);  // rule_parts.hpp

/// Faces of the parent that hold a node, one bit each, for every node of a rule.
inline std::vector<unsigned> face_incidence(const Rule& rule) {
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

inline bool inside_reference(Shape shape, const Point& x) {
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

/// Signed measure in reference coordinates.
inline double signed_reference_measure(Shape shape, std::span<const Point> x) {
    const Point v = measure_vector(shape, x);
    return topology(shape).dimension == 1 ? v[0] : v[2];
}

inline std::string node_name(const Rule& rule, std::size_t node) {
    const auto corners = static_cast<std::size_t>(rule.corner_count());
    return node < corners ? "corner " + std::to_string(node)
                          : "new node " + std::to_string(node - corners);
}

/// Puts the parents of a plain mean over a quadrilateral face into tensor order.
inline bool order_as_face(const Rule& rule, Stencil& stencil) {
    if (stencil.count != 4) return false;
    const Topology& t = topology(rule.parent);
    std::array<std::uint8_t, 4> wanted{};
    std::copy_n(stencil.parent.begin(), 4, wanted.begin());
    std::sort(wanted.begin(), wanted.end());
    const auto matches = [&](std::array<std::uint8_t, 4> candidate) {
        auto sorted = candidate;
        std::sort(sorted.begin(), sorted.end());
        if (sorted != wanted) return false;
        std::copy_n(candidate.begin(), 4, stencil.parent.begin());
        return true;
    };
    if (rule.parent == Shape::quadrilateral && matches({0, 1, 2, 3})) return true;
    for (std::size_t f = 0; f < t.faces; ++f) {
        const FaceTopology& face = t.face[f];
        if (face.corners != 4) continue;
        if (matches({face.tensor_corner(0), face.tensor_corner(1), face.tensor_corner(2),
                     face.tensor_corner(3)})) {
            return true;
        }
    }
    return false;
}

inline void complete_stencil(const Rule& rule, Stencil& s) {
    std::vector<double> distinct(s.weight.begin(), s.weight.begin() + s.count);
    std::sort(distinct.rbegin(), distinct.rend());
    distinct.erase(std::unique(distinct.begin(), distinct.end(),
                               [](double a, double b) { return std::abs(a - b) < 1e-12; }),
                   distinct.end());
    for (std::size_t i = 0; i < s.count; ++i) {
        const auto place = std::find_if(distinct.begin(), distinct.end(), [&](double w) {
            return std::abs(w - s.weight[i]) < 1e-12;
        });
        s.rank[i] = static_cast<std::uint8_t>(place - distinct.begin());
    }
    s.mean = Mean::weighted;
    if (distinct.size() != 1) return;
    if (s.count == 2) s.mean = Mean::midpoint;
    if (s.count == 8) s.mean = Mean::cell;
    if (order_as_face(rule, s)) s.mean = Mean::face;
}

inline std::optional<std::string> find_stencil_violation(const Rule& rule) {
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

inline std::optional<std::string> find_child_violation(const Rule& rule) {
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
        if (!(child.orientation * signed_reference_measure(child.shape, x) > rule_tolerance)) {
            return who + " is inverted or flat under its orientation sign";
        }
    }
    return std::nullopt;
}

/// Whether a loop of corners runs upwards after its least one: its sense, whatever its start.
inline bool runs_upwards(std::span<const std::uint8_t> loop) {
    const auto least =
        static_cast<std::size_t>(std::min_element(loop.begin(), loop.end()) - loop.begin());
    const std::size_t n = loop.size();
    return n == 2 ? least == 0 : loop[(least + 1) % n] < loop[(least + n - 1) % n];
}

/// Interior faces belong to two children, which see them from opposite sides, and the volumes add
/// up.
inline std::optional<std::string> find_tiling_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    const std::vector<Point> nodes = reference_nodes(rule);
    const std::vector<unsigned> incidence = face_incidence(rule);
    std::map<std::array<std::uint8_t, 4>, std::array<int, 2>> uses;  // from either side
    double volume = 0;
    for (const Child& child : rule.children) {
        const Topology& t = topology(child.shape);
        std::vector<Point> x(t.corners);
        for (std::size_t i = 0; i < t.corners; ++i) x[i] = nodes[child.corner[i]];
        volume += child.orientation * signed_reference_measure(child.shape, x);
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
    const double parent = signed_reference_measure(
        rule.parent, std::span(nodes).first(static_cast<std::size_t>(rule.corner_count())));
    if (!(std::abs(volume - parent) < rule_tolerance)) {
        return name + "volume lost: the children hold " + std::to_string(volume / parent) +
               " of their father";
    }
    for (const auto& [face, sides] : uses) {
        if (sides[0] != 1 || sides[1] != 1) {
            return name + "an inner face belongs to " + std::to_string(sides[0]) + " and " +
                   std::to_string(sides[1]) + " children on its two sides, not to one on each";
        }
    }
    return std::nullopt;
}

}  // namespace detail

inline Stencil weighted_mean_of(std::initializer_list<std::pair<int, double>> parents, int number) {
    Stencil s;
    for (const auto& [parent, weight] : parents) {
        if (s.count == max_corners) throw InvalidInput("a stencil has at most 8 parents");
        s.parent[s.count] = static_cast<std::uint8_t>(parent);
        s.weight[s.count++] = weight;
    }
    s.number = static_cast<std::uint8_t>(number);
    return s;
}

inline Stencil mean_of(std::initializer_list<int> parents) {
    Stencil s;
    for (const int parent : parents) {
        if (s.count == max_corners) throw InvalidInput("a stencil has at most 8 parents");
        s.parent[s.count] = static_cast<std::uint8_t>(parent);
        s.weight[s.count++] = 1.0 / static_cast<double>(parents.size());
    }
    return s;
}

inline std::vector<Point> reference_nodes(const Rule& rule) {
    const Topology& t = topology(rule.parent);
    std::vector<Point> nodes(t.reference.begin(), t.reference.begin() + t.corners);
    for (const Stencil& s : rule.new_nodes) {
        Point x{0, 0, 0};
        for (std::size_t i = 0; i < s.count; ++i) x = x + s.weight[i] * nodes[s.parent[i]];
        nodes.push_back(x);
    }
    return nodes;
}

inline std::optional<std::string> find_violation(const Rule& rule) {
    const std::string name = "rule '" + rule.name + "': ";
    if (rule.parent == Shape::point) return name + "a point has no children";
    if (rule.children.empty()) return name + "there are no children";
    if (rule.children.size() > max_children) return name + "more than 64 children";
    if (rule.new_nodes.size() > max_new_nodes) return name + "more than 64 new nodes";
    if (auto v = detail::find_stencil_violation(rule)) return v;
    if (auto v = detail::find_child_violation(rule)) return v;
    return detail::find_tiling_violation(rule);
}

inline Rule make_rule(std::string name, Shape parent, std::vector<Stencil> new_nodes,
                      std::vector<Child> children) {
    Rule rule;
    rule.name = std::move(name);
    rule.parent = parent;
    rule.new_nodes = std::move(new_nodes);
    rule.children = std::move(children);
    if (auto violation = find_violation(rule)) throw InvalidInput(*violation);
    for (Stencil& s : rule.new_nodes) detail::complete_stencil(rule, s);
    rule.new_corner.resize(rule.new_nodes.size());
    std::vector<int> rank(rule.new_nodes.size(), 3);
    for (std::size_t c = 0; c < rule.children.size(); ++c) {
        const Child& child = rule.children[c];
        const std::size_t corners = topology(child.shape).corners;
        for (std::size_t i = 0; i < corners; ++i) {
            if (child.corner[i] < rule.corner_count()) continue;
            const auto n = static_cast<std::size_t>(child.corner[i] - rule.corner_count());
            const int here = i == 0 ? 0 : i + 1 == corners ? 1 : 2;
            if (here >= rank[n]) continue;
            rank[n] = here;
            rule.new_corner[n] = {static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(i)};
        }
    }
    const std::vector<unsigned> incidence = detail::face_incidence(rule);
    for (Child& child : rule.children) {
        child.parent_face.fill(no_face);
        const Topology& t = topology(child.shape);
        for (std::size_t f = 0; f < t.faces; ++f) {
            unsigned common = ~0U;
            for (std::size_t i = 0; i < t.face[f].corners; ++i) {
                common &= incidence[child.corner[t.face[f].corner[i]]];
            }
            for (std::uint8_t g = 0; g < topology(rule.parent).faces; ++g) {
                if ((common >> g & 1U) != 0) child.parent_face[f] = g;
            }
        }
    }
    std::vector<int> steps(static_cast<std::size_t>(rule.corner_count()), 0);
    for (const Stencil& s : rule.new_nodes) {
        int step = 0;
        for (std::size_t i = 0; i < s.count; ++i) step = std::max(step, steps[s.parent[i]]);
        steps.push_back(step + 1);
        rule.steps = std::max(rule.steps, step + 1);
    }
    detail::find_parts(rule);
    detail::place_in_parts(rule);
    return rule;
}

}  // namespace nestgrid
