// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The edges and faces of a rule: those of the parent, and those that appear between two steps of a
// rule that takes several.
#include <algorithm>
#include <bit>
#include <span>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

#include "derived_members.hpp"

namespace nestgrid::detail {

namespace {

/// Sets of nodes of one rule: closed under "all parents of a new node are in it".
class NodeSet {
public:
    NodeSet(const Rule& rule, std::span<const std::uint8_t> nodes) {
        const auto corners = static_cast<std::size_t>(rule.corner_count());
        has_.assign(corners + rule.new_nodes.size(), false);
        for (const std::uint8_t n : nodes) has_[n] = true;
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const Stencil& s = rule.new_nodes[n];
            const auto parents = std::span(s.parent).first(s.count);
            if (std::all_of(parents.begin(), parents.end(), [&](auto p) { return has_[p]; })) {
                has_[corners + n] = true;
            }
        }
        for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
            const auto at = static_cast<std::uint8_t>(corners + n);
            if (has_[at] && std::find(nodes.begin(), nodes.end(), at) == nodes.end()) {
                inner |= NodeMask{1} << n;
            }
        }
    }

    bool contains(std::span<const std::uint8_t> nodes) const {
        return std::all_of(nodes.begin(), nodes.end(), [&](auto n) { return has_[n]; });
    }

    NodeMask inner = 0;  ///< new nodes in the set that are not among those that made it

private:
    std::vector<bool> has_;
};

bool same_nodes(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b) {
    return a.size() == b.size() && std::is_permutation(a.begin(), a.end(), b.begin());
}

std::span<const std::uint8_t> corners_of(const RuleFace& face) {
    return std::span(face.corner).first(face.corners);
}

/// The loop of a face of the parent with nodes p and q put where they lie on its edges, or nothing
/// where one does not.
std::vector<std::uint8_t> loop_through(const Rule& rule, const RuleFace& face, std::uint8_t p,
                                       std::uint8_t q) {
    std::vector<std::uint8_t> loop;
    for (std::size_t i = 0; i < face.corners; ++i) {
        const std::array<std::uint8_t, 2> side{face.corner[i],
                                               face.corner[(i + 1U) % face.corners]};
        loop.push_back(side[0]);
        const NodeSet on_side(rule, side);
        for (const std::uint8_t n : {p, q}) {
            const std::array<std::uint8_t, 1> one{n};
            if (n != side[0] && n != side[1] && on_side.contains(one)) loop.push_back(n);
        }
    }
    const auto has = [&](std::uint8_t n) { return std::count(loop.begin(), loop.end(), n) == 1; };
    return has(p) && has(q) ? loop : std::vector<std::uint8_t>{};
}

/// The parts of a face on both sides of the edge p q.
std::vector<RuleFace> cut_face(const Rule& rule, std::uint8_t face, std::uint8_t p,
                               std::uint8_t q) {
    std::vector<std::uint8_t> loop = loop_through(rule, rule.faces[face], p, q);
    std::vector<RuleFace> parts;
    if (loop.empty()) return parts;
    std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), p), loop.end());
    const auto middle = std::find(loop.begin(), loop.end(), q);
    std::vector<std::uint8_t> first(loop.begin(), middle + 1);
    std::vector<std::uint8_t> second(middle, loop.end());
    second.push_back(p);
    for (const auto& corners : {first, second}) {
        if (corners.size() < 3 || corners.size() > 4) return {};
        RuleFace part;
        part.parent = face;
        part.corners = static_cast<std::uint8_t>(corners.size());
        std::copy(corners.begin(), corners.end(), part.corner.begin());
        part.inner = NodeSet(rule, corners).inner;
        parts.push_back(part);
    }
    return parts;
}

/// Adds the edge between two nodes, and the parts into which it cuts a face of the parent, where it
/// lies inside a face and on no edge that the rule has.
void add_edge_in_faces(Rule& rule, const std::array<std::uint8_t, 2>& ends) {
    const Topology& t = topology(rule.parent);
    const bool known = std::any_of(rule.edges.begin(), rule.edges.end(), [&](const auto& e) {
        return NodeSet(rule, e.end).contains(ends);
    });
    for (std::uint8_t f = 0; f < t.faces && !known; ++f) {
        if (!NodeSet(rule, corners_of(rule.faces[f])).contains(ends)) continue;
        const std::vector<RuleFace> parts = cut_face(rule, f, ends[0], ends[1]);
        if (parts.empty()) continue;
        rule.edges.push_back({ends, NodeSet(rule, ends).inner});
        for (const std::uint8_t end : ends) {
            if (end >= t.corners) rule.faces[f].first |= NodeMask{1} << (end - t.corners);
        }
        rule.faces.insert(rule.faces.end(), parts.begin(), parts.end());
    }
}

/// Fills Child::rule_edge and Child::rule_edges.
void place_edges(const Rule& rule, Child& child) {
    const Topology& t = topology(child.shape);
    child.rule_edge.fill(no_edge);
    for (std::size_t e = 0; e < t.edges; ++e) {
        const std::array<std::uint8_t, 2> ends{child.corner[t.edge[e][0]],
                                               child.corner[t.edge[e][1]]};
        for (std::size_t r = 0; r < rule.edges.size(); ++r) {
            if (NodeSet(rule, rule.edges[r].end).contains(ends)) {
                child.rule_edge[e] = static_cast<std::uint8_t>(r);
            }
        }
    }
    for (const std::uint8_t e : child.rule_edge) {
        if (e != no_edge) child.rule_edges |= 1U << e;
    }
}

/// Fills Child::rule_face and Child::rule_faces, and RuleFace::divided as far as this child says.
void place_faces(Rule& rule, Child& child) {
    const Topology& t = topology(child.shape);
    child.rule_face.fill(no_face);
    for (std::size_t f = 0; f < t.faces; ++f) {
        std::vector<std::uint8_t> corners;
        for (std::size_t i = 0; i < t.face[f].corners; ++i) {
            corners.push_back(child.corner[t.face[f].corner[i]]);
        }
        for (std::size_t r = 0; r < rule.faces.size(); ++r) {
            RuleFace& face = rule.faces[r];
            if (!NodeSet(rule, corners_of(face)).contains(corners)) continue;
            const bool whole = same_nodes(corners, corners_of(face));
            face.divided = face.divided || !whole;
            if (face.parent == no_face || !whole) {
                child.rule_face[f] = static_cast<std::uint8_t>(r);
            }
        }
    }
    for (const std::uint8_t f : child.rule_face) {
        if (f != no_face) child.rule_faces |= 1U << f;
    }
}

}  // namespace

void find_parts(Rule& rule) {
    const Topology& t = topology(rule.parent);
    for (std::size_t e = 0; e < t.edges; ++e) {
        rule.edges.push_back({t.edge[e], NodeSet(rule, t.edge[e]).inner});
    }
    if (t.dimension < 3) return;
    for (std::size_t f = 0; f < t.faces; ++f) {
        RuleFace face;
        face.corners = t.face[f].corners;
        face.corner = t.face[f].corner;
        face.inner = NodeSet(rule, corners_of(face)).inner;
        rule.faces.push_back(face);
    }
    for (const Stencil& s : rule.new_nodes) {
        if (s.count == 2) add_edge_in_faces(rule, {s.parent[0], s.parent[1]});
    }
    if (rule.edges.size() > max_rule_edges || rule.faces.size() > max_rule_faces) {
        throw InvalidInput("rule '" + rule.name + "' has too many edges inside the parent's faces");
    }
}

void place_in_parts(Rule& rule) {
    static_assert(max_rule_edges <= 32 && max_rule_faces <= 32);
    for (Child& child : rule.children) {
        place_edges(rule, child);
        place_faces(rule, child);
    }
    NodeMask around = 0;
    for (const RuleEdge& edge : rule.edges) around |= edge.inner;
    for (const RuleFace& face : rule.faces) around |= face.inner;
    if ((rule.all() & ~around) != 0) {
        rule.inside = static_cast<std::uint8_t>(std::countr_zero(rule.all() & ~around));
    }
    for (RuleFace& face : rule.faces) {
        if (face.divided && face.inner == 0) rule.divides_bare_faces = true;
        if (face.first == 0) face.first = face.inner;
        face.one_way = face.divided && face.corners == 4 && std::popcount(face.first) <= 2;
    }
    const Topology& t = topology(rule.parent);
    rule.divides_all = std::all_of(rule.edges.begin(), rule.edges.begin() + t.edges,
                                   [](const RuleEdge& edge) { return edge.inner != 0; }) &&
                       std::all_of(rule.faces.begin(), rule.faces.end(), [](const RuleFace& face) {
                           return face.divided && !face.one_way;
                       });
}

}  // namespace nestgrid::detail
