// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Deriving the hanging nodes of a grid whose adapter does not know them.
//
// A node that hangs on a leaf would have been created by refining an edge or a face of that leaf,
// so its key is known without the node: every leaf probes the would-be keys of its edges and faces,
// and, where one exists, those of the parts, recursively. This finds nodes that a test of faces
// misses, because the coarse leaf touches the finer element in an edge only.
// Costs O(nodes) memory while it runs, and keeps the keys of hanging nodes.
#pragma once

#include <nestgrid/traversal.hpp>

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
    void add_node(NodeKey key) { nodes_.insert(key, {}); }

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

    bool exists(NodeKey key) const { return nodes_.find(key) != nullptr; }
    static NodeKey middle(NodeKey a, NodeKey b) { return mean_key(a + b, 2); }

    void probe_edge(NodeKey a, NodeKey b) {
        const NodeKey m = middle(a, b);
        if (!exists(m)) return;
        hanging_.insert(m);
        probe_edge(a, m);
        probe_edge(m, b);
    }

    /// Bisected or refined into four, along any of its edges.
    void probe_triangle(NodeKey a, NodeKey b, NodeKey c) {
        if (!triangles_.insert(mean_key(a + b + c, 3), {}).second) return;
        const std::array<std::array<NodeKey, 3>, 3> turns{{{a, b, c}, {b, c, a}, {c, a, b}}};
        bool all = true;
        for (const auto& [p, q, r] : turns) {
            const NodeKey m = middle(p, q);
            all = all && exists(m);
            if (!exists(m)) continue;
            probe_edge(m, r);
            probe_triangle(p, m, r);
            probe_triangle(m, q, r);
        }
        if (!all) return;
        const NodeKey ab = middle(a, b);
        const NodeKey bc = middle(b, c);
        const NodeKey ca = middle(c, a);
        probe_edge(ab, bc);
        probe_edge(bc, ca);
        probe_edge(ca, ab);
        probe_triangle(a, ab, ca);
        probe_triangle(ab, b, bc);
        probe_triangle(ca, bc, c);
        probe_triangle(ab, bc, ca);
    }

    /// Corners in tensor order; refined into four, or halved in one direction.
    void probe_quadrilateral(NodeKey a, NodeKey b, NodeKey c, NodeKey d) {
        const NodeKey ab = middle(a, b);
        const NodeKey cd = middle(c, d);
        const NodeKey ac = middle(a, c);
        const NodeKey bd = middle(b, d);
        const NodeKey centre = mean_key(a + b + c + d, 4);
        if (exists(centre)) {
            hanging_.insert(centre);
            for (const NodeKey m : {ab, cd, ac, bd}) probe_edge(m, centre);
            probe_quadrilateral(a, ab, ac, centre);
            probe_quadrilateral(ab, b, centre, bd);
            probe_quadrilateral(ac, centre, c, cd);
            probe_quadrilateral(centre, bd, cd, d);
            return;
        }
        if (exists(ab) && exists(cd)) {
            probe_edge(ab, cd);
            probe_quadrilateral(a, ab, c, cd);
            probe_quadrilateral(ab, b, cd, d);
        }
        if (exists(ac) && exists(bd)) {
            probe_edge(ac, bd);
            probe_quadrilateral(a, b, ac, bd);
            probe_quadrilateral(ac, bd, c, d);
        }
    }

    KeyTable<NodeKey, Present> nodes_;
    KeyTable<NodeKey, Present> triangles_;
    HangingNodes hanging_;
};

struct CollectNodes {
    HangingProbe& probe;
    template <class State>
    Decision inspect(const State&, const Split& split) {
        for (const NodeKey key : split.keys) probe.add_node(key);
        return {};
    }
    template <class State>
    void extract(const State&) {}
};

template <class Walk>
struct ProbeLeaves {
    const Walk& walk;
    HangingProbe& probe;
    template <class State>
    Decision inspect(const State&, const Split&) {
        return {};
    }
    template <class State>
    void extract(const State& s) {
        std::array<NodeKey, max_corners> keys;
        walk.keys(s, keys);
        probe.probe_leaf(s.shape, std::span<const NodeKey>(keys.data(), max_corners));
    }
};

}  // namespace detail

/// The hanging nodes of a grid with derived keys.
/// \throw GridError for a grid with own keys, which must offer `constrained` or be `conforming`
template <class Grid>
HangingNodes derive_hanging_nodes(const Grid& grid) {
    if (offers(grid, Feature::own_keys)) {
        throw GridError(
            "a grid with own node keys must offer 'constrained' or say that it is 'conforming'");
    }
    const ZeroField<Grid> zero;
    const Traversal<Grid, ZeroField<Grid>, Needs{.keys = true}> walk(grid, zero);
    detail::HangingProbe probe;
    detail::CollectNodes collect{probe};
    walk.run(collect);
    detail::ProbeLeaves<decltype(walk)> leaves{walk, probe};
    walk.run(leaves);
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
