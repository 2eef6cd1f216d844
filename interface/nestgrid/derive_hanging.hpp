// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Deriving the hanging nodes of a grid whose adapter does not know them.
//
// A node that hangs on a leaf would have been created by refining an edge or a face of that leaf,
// so its parents are known without the node: every leaf probes for nodes with the parents that its
// edges and faces have, and, where there is one, for those of the parts, recursively. This finds
// nodes that a test of faces misses, because the coarse leaf touches the finer element in an edge
// only. Keys may be derived or the grid's own.
// Costs O(nodes) memory while it runs, and keeps the keys of hanging nodes.
#pragma once

#include <nestgrid/key_filter.hpp>
#include <nestgrid/levels.hpp>

namespace nestgrid {

/// A field that is zero, for walks that look at the grid alone.
template <class Grid>
struct ZeroField {
    using value_type = float;
    NodeMask coarse_values(std::size_t, std::span<float> out) const {
        std::fill(out.begin(), out.end(), 0.0F);
        return 0;
    }
    NodeMask new_values(const ElementOf<Grid>&, NodeMask, std::span<float> out) const {
        std::fill(out.begin(), out.end(), 0.0F);
        return 0;
    }
};

namespace detail {

class HangingProbe {
public:
    /// The new nodes of a split; `corners` and `nodes` are keys, in the order of the rule.
    void add_nodes(const Rule& rule, std::span<const NodeKey> corners,
                   std::span<const NodeKey> nodes) {
        std::array<NodeKey, max_corners + max_new_nodes> mixed;
        const auto count = static_cast<std::size_t>(rule.corner_count());
        for (std::size_t i = 0; i < count; ++i) mixed[i] = mix(corners[i]);
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            nodes_.insert(derived_key(rule.new_nodes[n], mixed.data()), nodes[n]);
            mixed[count + n] = mix(nodes[n]);
        }
    }

    /// Between the last add_nodes() and the first probe_leaf().
    void finish() {
        parents_.reset(nodes_.size());
        nodes_.for_each([&](NodeKey parents, NodeKey) { parents_.add(hash(parents)); });
    }

    void probe_leaf(Shape shape, std::span<const NodeKey> k) {
        const Topology& t = topology(shape);
        for (std::size_t e = 0; e < t.edges; ++e) probe_edge(k[t.edge[e][0]], k[t.edge[e][1]]);
        for (std::size_t f = 0; t.dimension == 3 && f < t.faces; ++f) {
            const FaceTopology& face = t.face[f];
            const auto at = [&](int i) { return k[face.tensor_corner(i)]; };
            if (face.corners == 3) probe_triangle(at(0), at(1), at(2));
            if (face.corners == 4) probe_quadrilateral(at(0), at(1), at(2), at(3));
        }
    }

    HangingNodes take() { return std::move(hanging_); }

private:
    struct Present {};
    /// The key of a node that exists, or null.
    using Found = const NodeKey*;

    /// The node in the middle of others. Own keys may be small numbers, whose sums coincide, so
    /// each is mixed first.
    template <class... Keys>
    Found middle(Keys... of) const {
        const NodeKey parents = mean_key((mix(of) + ...), sizeof...(of));
        return parents_.perhaps(hash(parents)) ? nodes_.find(parents) : nullptr;
    }

    void probe_edge(NodeKey a, NodeKey b) {
        const Found m = middle(a, b);
        if (m == nullptr) return;
        hanging_.insert(*m);
        probe_edge(a, *m);
        probe_edge(*m, b);
    }

    /// Bisected or refined into four, along any of its edges.
    void probe_triangle(NodeKey a, NodeKey b, NodeKey c) {
        const Found ab = middle(a, b);
        const Found bc = middle(b, c);
        const Found ca = middle(c, a);
        if (ab == nullptr && bc == nullptr && ca == nullptr) return;
        if (!triangles_.insert(mean_key(mix(a) + mix(b) + mix(c), 3), {}).second) return;
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
        const Found ab = middle(a, b);
        const Found cd = middle(c, d);
        const Found ac = middle(a, c);
        const Found bd = middle(b, d);
        const Found centre = middle(a, b, c, d);
        const bool across = ab != nullptr && cd != nullptr;
        const bool along = ac != nullptr && bd != nullptr;
        if (centre != nullptr && across && along) {
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

    KeyTable<NodeKey, NodeKey> nodes_;  // by their parents
    KeyFilter parents_;
    KeyTable<NodeKey, Present> triangles_;
    HangingNodes hanging_;
};

}  // namespace detail

/// The hanging nodes of a grid.
template <class Grid>
HangingNodes derive_hanging_nodes(const Grid& grid) {
    const ZeroField<Grid> zero;
    const Traversal<Grid, ZeroField<Grid>, Needs{.keys = true}> walk(grid, zero);
    detail::HangingProbe probe;
    std::array<NodeKey, max_corners> keys;
    for_each_element<true>(walk, [&](const auto& s, const Split& split) {
        if (split.rule == nullptr) return;
        walk.keys(s, keys);
        probe.add_nodes(*split.rule, keys, split.keys);
    });
    probe.finish();
    for_each_element(walk, [&](const auto& s, const Split& split) {
        if (split.rule != nullptr || is_hidden(grid, *s.context, s.element)) return;
        walk.keys(s, keys);
        probe.probe_leaf(s.shape, keys);
    });
    return probe.take();
}

/// Whether the hanging nodes must be derived: the grid neither names them nor is conforming.
template <class Grid>
bool hanging_nodes_unknown(const Grid& grid) {
    if (offers(grid, Feature::constrained)) return false;
    if constexpr (requires { grid.conforming(); }) {
        return !grid.conforming();
    } else {
        return true;
    }
}

}  // namespace nestgrid
