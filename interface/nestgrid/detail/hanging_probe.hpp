// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the hanging nodes of a grid whose adapter does not know them.
//
// A node that hangs on a leaf would have been created by refining an edge or a face of that leaf,
// so its parents are known without the node: every leaf probes for nodes with the parents that its
// edges and faces have, and, where there is one, for those of the parts, recursively. This finds
// nodes that a test of faces misses, because the coarse leaf touches the finer element in an edge
// only. Keys may be derived or the grid's own.
// The probe relies on this: where a face is divided on both sides, both sides divide it alike, or
// one of them along one direction only and the other along the other one only. crossed_face()
// finds the quadrilaterals where this does not hold: nodes there hang on others than their parents.
// Where the grid gives the parents of nodes that hang on edges (optional.hpp), the probe relies on
// these instead, and crossed_face() finds the quadrilaterals where they are missing.
// Nodes at weighted means are not looked for: where one hangs on an edge of a leaf, the grid must
// name its hanging nodes (hangs_at_weights()).
// Costs O(nodes) memory while it runs, and keeps the keys of hanging nodes.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/detail/key_filter.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid::detail {

/// A quadrilateral that a rule divides in one direction first, by nodes of the rule: its corners in
/// tensor order, and the nodes that divide the edges 01 and 23.
struct OneWayFace {
    std::array<std::uint8_t, 4> corner;
    std::array<std::uint8_t, 2> line;
};

/// The node that a rule makes with some parents; 0, a corner, where it makes none.
inline std::uint8_t node_with_parents(const Rule& rule, std::initializer_list<std::uint8_t> of) {
    for (std::size_t n = 0; n < rule.new_nodes.size(); ++n) {
        const Stencil& s = rule.new_nodes[n];
        if (s.count == of.size() && s.mean != Mean::weighted &&
            std::is_permutation(of.begin(), of.end(), s.parent.begin())) {
            return static_cast<std::uint8_t>(static_cast<std::size_t>(rule.corner_count()) + n);
        }
    }
    return 0;
}

/// The quadrilaterals, parts of faces included, that a rule divides in one direction first.
/// \param of_four also the halves of each face that the rule divides into four
inline std::vector<OneWayFace> one_way_faces(const Rule& rule, bool of_four) {
    std::vector<OneWayFace> result;
    for (const RuleFace& face : rule.faces) {
        if (face.corners != 4 || !face.divided) continue;
        const auto& c = face.corner;
        const std::uint8_t m01 = node_with_parents(rule, {c[0], c[1]});
        const std::uint8_t m12 = node_with_parents(rule, {c[1], c[2]});
        const std::uint8_t m23 = node_with_parents(rule, {c[2], c[3]});
        const std::uint8_t m30 = node_with_parents(rule, {c[3], c[0]});
        const auto is_first = [&](std::uint8_t node) {
            return node != 0 && (face.first >> (node - rule.corner_count()) & 1U) != 0;
        };
        if (face.one_way) {
            if (is_first(m01) && is_first(m23)) {
                result.push_back({{c[0], c[1], c[3], c[2]}, {m01, m23}});
            }
            if (is_first(m12) && is_first(m30)) {
                result.push_back({{c[1], c[2], c[0], c[3]}, {m12, m30}});
            }
            continue;
        }
        const std::uint8_t centre = node_with_parents(rule, {c[0], c[1], c[2], c[3]});
        if (!of_four || centre == 0) continue;
        result.push_back({{c[0], c[3], m01, m23}, {m30, centre}});
        result.push_back({{m01, m23, c[1], c[2]}, {centre, m12}});
        result.push_back({{c[0], c[1], m30, m12}, {m01, centre}});
        result.push_back({{m30, m12, c[3], c[2]}, {centre, m23}});
    }
    return result;
}

class HangingProbe {
public:
    /// The new nodes of a split; `corners` and `nodes` are keys, in the order of the rule.
    void add_nodes(const Rule& rule, std::span<const NodeKey> corners,
                   std::span<const NodeKey> nodes) {
        std::array<NodeKey, max_corners + max_new_nodes> mixed;
        std::array<NodeKey, max_new_nodes> parents;
        const auto count = static_cast<std::size_t>(rule.corner_count());
        for (std::size_t i = 0; i < count; ++i) mixed[i] = mix(corners[i]);
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            parents[n] = derived_key(rule.new_nodes[n], mixed.data());
            mixed[count + n] = mix(nodes[n]);
            nodes_.prefetch(parents[n]);
        }
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            nodes_.insert(parents[n], nodes[n]);
            const Stencil& s = rule.new_nodes[n];
            if (s.mean != Mean::weighted || s.count != 2) continue;
            weighted_.insert(mean_key(mixed[s.parent[0]] + mixed[s.parent[1]], 2), {});
        }
        divides_one_way_ = divides_one_way_ || !faces_of(rule).empty();
    }

    /// The parents that the grid gives a node. After add_nodes(), before finish().
    void add_parents(NodeKey node, const KeyPair& parents) {
        nodes_.insert(parents_key(parents.low, parents.high), node);
        given_.insert(node, {parents});
    }
    /// Must be called before the first add_nodes() where the grid gives parents at all.
    void rely_on_given_parents() { relies_on_given_ = true; }

    /// Between the last add_nodes() and the first probe_leaf().
    void finish() {
        parents_.reset(nodes_.size());
        nodes_.for_each([&](NodeKey parents, NodeKey) { parents_.add(hash(parents)); });
    }

    void probe_leaf(Shape shape, std::span<const NodeKey> k) {
        const Topology& t = topology(shape);
        std::array<Found, max_edges> middle_of{};
        bool any = false;
        for (std::size_t e = 0; e < t.edges; ++e) {
            const NodeKey a = k[t.edge[e][0]];
            const NodeKey b = k[t.edge[e][1]];
            middle_of[e] = middle(a, b);
            any = any || middle_of[e] != nullptr;
            probe_parts(a, b, middle_of[e], true);
        }
        // A face that is divided has an edge that is.
        for (std::size_t f = 0; any && t.dimension == 3 && f < t.faces; ++f) {
            const FaceTopology& face = t.face[f];
            const auto at = [&](int i) { return k[face.tensor_corner(i)]; };
            const auto between = [&](int i, int j) {
                return middle_of[edge_between(shape, face.tensor_corner(i), face.tensor_corner(j))];
            };
            if (face.corners == 3) {
                probe_triangle(at(0), at(1), at(2), between(0, 1), between(1, 2), between(2, 0));
            } else {
                probe_quadrilateral(at(0), at(1), at(2), at(3), between(0, 1), between(2, 3),
                                    between(0, 2), between(1, 3));
            }
        }
    }

    /// Probes for nodes inside an edge, a triangle or a quadrilateral of a leaf, whose corners are
    /// in tensor order.
    void probe_part(std::span<const NodeKey> k) {
        if (k.size() == 2) probe_edge(k[0], k[1]);
        if (k.size() == 3) probe_triangle(k[0], k[1], k[2]);
        if (k.size() == 4) probe_quadrilateral(k[0], k[1], k[2], k[3]);
    }
    /// Whether nodes lie across the line between the middles of 01 and 23 of a quadrilateral, in
    /// tensor order, that an element elsewhere divides there first.
    bool crosses(const std::array<NodeKey, 4>& corner) const {
        return is_crossed(corner, nullptr, nullptr);
    }

    HangingNodes take() { return std::move(hanging_); }

    /// The given parents of a node that hangs between them on an edge of a leaf; else null.
    const KeyPair* parents_on_edge(NodeKey node) const {
        const Given* given = given_.find(node);
        return given != nullptr && given->on_edge ? &given->parents : nullptr;
    }
    /// A node that hangs on an edge of a leaf between others than its given parents.
    const std::optional<NodeKey>& contradiction() const { return contradiction_; }

    /// Whether a node hangs on an edge of a leaf that was probed, or on a part of one, that is no
    /// mean of its ends with equal weights.
    bool hangs_at_weights() const { return hangs_at_weights_; }

    /// Whether some split divides a quadrilateral in one direction first; else no face is crossed.
    bool divides_one_way() const { return divides_one_way_; }

    /// A quadrilateral that a split divides in one direction first, while an element on its other
    /// side divides it in both directions, first or later in the other one, and a node where the
    /// divisions cross has no parents on the line of this split. After finish().
    /// \param keys of the corners, then of the new nodes
    std::optional<OneWayFace> crossed_face(const Rule& rule, std::span<const NodeKey> keys) {
        for (const OneWayFace& face : faces_of(rule)) {
            const auto& c = face.corner;
            if (is_crossed({keys[c[0]], keys[c[1]], keys[c[2]], keys[c[3]]}, &keys[face.line[0]],
                           &keys[face.line[1]])) {
                return face;
            }
        }
        return std::nullopt;
    }

private:
    struct Present {};
    struct Given {
        KeyPair parents;
        bool on_edge = false;  ///< of a leaf
    };
    /// The key of a node that exists, or null.
    using Found = const NodeKey*;

    /// Names the mean of some nodes. Own keys may be small numbers, whose sums coincide, so each is
    /// mixed first.
    template <class... Keys>
    static NodeKey parents_key(Keys... of) {
        return mean_key((mix(of) + ...), sizeof...(of));
    }
    /// The node in the middle of others.
    template <class... Keys>
    Found middle(Keys... of) const {
        const NodeKey parents = parents_key(of...);
        return parents_.perhaps(hash(parents)) ? nodes_.find(parents) : nullptr;
    }

    /// \param of_leaf whether it is an edge of the leaf or a part of one
    void probe_edge(NodeKey a, NodeKey b, bool of_leaf = false) {
        probe_parts(a, b, middle(a, b), of_leaf);
    }
    /// \param m the node in the middle of the edge, or null
    void probe_parts(NodeKey a, NodeKey b, Found m, bool of_leaf) {
        if (weighted_.size() > 0 && weighted_.find(parents_key(a, b)) != nullptr) {
            hangs_at_weights_ = true;
        }
        if (m == nullptr) return;
        hanging_.insert(*m);
        if (of_leaf) note_on_edge(a, b, *m);
        probe_edge(a, *m, of_leaf);
        probe_edge(*m, b, of_leaf);
    }

    /// Bisected or refined into four, along any of its edges.
    void probe_triangle(NodeKey a, NodeKey b, NodeKey c) {
        probe_triangle(a, b, c, middle(a, b), middle(b, c), middle(c, a));
    }
    void probe_triangle(NodeKey a, NodeKey b, NodeKey c, Found ab, Found bc, Found ca) {
        if (ab == nullptr && bc == nullptr && ca == nullptr) return;
        if (!triangles_.insert(parents_key(a, b, c), {}).second) return;
        const auto bisected = [&](Found m, NodeKey p, NodeKey q, NodeKey r) {
            if (m == nullptr) return;
            probe_edge(*m, r);
            probe_triangle(p, *m, r);
            probe_triangle(*m, q, r);
        };
        bisected(ab, a, b, c);
        bisected(bc, b, c, a);
        bisected(ca, c, a, b);
        if (ab == nullptr || bc == nullptr || ca == nullptr) return;
        probe_edge(*ab, *bc);
        probe_edge(*bc, *ca);
        probe_edge(*ca, *ab);
        probe_triangle(a, *ab, *ca);
        probe_triangle(*ab, b, *bc);
        probe_triangle(*ca, *bc, c);
        probe_triangle(*ab, *bc, *ca);
    }

    /// Corners in tensor order; refined into four, or halved in one direction.
    void probe_quadrilateral(NodeKey a, NodeKey b, NodeKey c, NodeKey d) {
        probe_quadrilateral(a, b, c, d, middle(a, b), middle(c, d), middle(a, c), middle(b, d));
    }
    void probe_quadrilateral(NodeKey a, NodeKey b, NodeKey c, NodeKey d, Found ab, Found cd,
                             Found ac, Found bd) {
        const bool across = ab != nullptr && cd != nullptr;
        const bool along = ac != nullptr && bd != nullptr;
        const Found centre = across && along ? middle(a, b, c, d) : nullptr;
        if (centre != nullptr) {
            hanging_.insert(*centre);
            for (const Found m : {ab, cd, ac, bd}) probe_edge(*m, *centre);
            probe_quadrilateral(a, *ab, *ac, *centre);
            probe_quadrilateral(*ab, b, *centre, *bd);
            probe_quadrilateral(*ac, *centre, c, *cd);
            probe_quadrilateral(*centre, *bd, *cd, d);
            return;
        }
        if (across) {
            probe_edge(*ab, *cd);
            probe_quadrilateral(a, *ab, c, *cd);
            probe_quadrilateral(*ab, b, *cd, d);
        }
        if (along) {
            probe_edge(*ac, *bd);
            probe_quadrilateral(a, b, *ac, *bd);
            probe_quadrilateral(*ac, *bd, c, d);
        }
    }

    /// one_way_faces(), made once for each rule.
    const std::vector<OneWayFace>& faces_of(const Rule& rule) {
        const bool divides_all = rule.divides_all && !relies_on_given_;
        if (divides_all || rule.parent == Shape::tetrahedron) return none_;
        if (&rule != last_rule_) {
            const auto at = one_way_.find(&rule);
            last_faces_ =
                at != one_way_.end()
                    ? &at->second
                    : &one_way_.emplace(&rule, one_way_faces(rule, relies_on_given_)).first->second;
            last_rule_ = &rule;
        }
        return *last_faces_;
    }

    /// One side of a face divides its edges ab and cd first; so no node of the other side lies
    /// between nodes of ac and bd, but for nodes that lie in the middle of `low` and `high`, too.
    /// \param corner a, b, c, d in tensor order
    /// \param low, high the ends of the part of the dividing line that lies in the face, or null
    bool is_crossed(const std::array<NodeKey, 4>& corner, Found low, Found high) const {
        const auto [a, b, c, d] = corner;
        const Found ac = middle(a, c);
        const Found bd = ac == nullptr ? nullptr : middle(b, d);
        if (bd == nullptr) return false;
        const Found centre = middle(a, b, c, d);
        const Found crossing = centre != nullptr ? centre : middle(*ac, *bd);
        const bool has_line = relies_on_given_ && low != nullptr && high != nullptr;
        const Found on_line = has_line ? middle(*low, *high) : nullptr;
        if (crossing != nullptr && (on_line == nullptr || *on_line != *crossing)) return true;
        return is_crossed({a, b, *ac, *bd}, low, on_line) ||
               is_crossed({*ac, *bd, c, d}, on_line, high);
    }

    /// Notes that a node hangs on an edge of a leaf, between a and b.
    void note_on_edge(NodeKey a, NodeKey b, NodeKey node) {
        Given* given = given_.find(node);
        if (given == nullptr) return;
        given->on_edge = true;
        if (!(given->parents == KeyPair{a, b})) contradiction_ = node;
    }

    KeyTable<NodeKey, NodeKey> nodes_;  // by their parents
    KeyFilter parents_;
    KeyTable<NodeKey, Present> triangles_;
    KeyTable<NodeKey, Present> weighted_;  // edges with nodes at weighted means, by their ends
    bool hangs_at_weights_ = false;
    HangingNodes hanging_;
    const std::vector<OneWayFace> none_{};
    std::map<const Rule*, std::vector<OneWayFace>> one_way_;
    const Rule* last_rule_ = nullptr;
    const std::vector<OneWayFace>* last_faces_ = nullptr;  // of that
    bool divides_one_way_ = false;
    KeyTable<NodeKey, Given> given_;
    bool relies_on_given_ = false;
    std::optional<NodeKey> contradiction_;
};

}  // namespace nestgrid::detail
