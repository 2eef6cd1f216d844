// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which edges and faces a split closes; included by traversal.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <utility>

#include <nestgrid/interpolate.hpp>
#include <nestgrid/traversal.hpp>

namespace nestgrid {

template <class Grid, class Field, Needs needs>
struct Traversal<Grid, Field, needs>::Parts {
    using Closed = typename State::Closed;
    static constexpr std::size_t edges = Closed::rule_edges;

    typename Closed::Edge::Split split;
    std::array<typename Closed::Edge, edges> closed_edge;
    std::array<const typename Closed::Edge*, edges + 1> edge;  // around each edge of the rule
    std::array<ClosedFace, max_rule_faces> closed_face;
    std::array<const ClosedFace*, max_rule_faces + 1> face;  // around parts of each of its faces
    std::uint32_t edges_closed = 0;                          // those around which there is any
    std::uint32_t faces_closed = 0;

    Parts() {
        edge[edges] = nullptr;  // around those that are no edges of the rule
        face[max_rule_faces] = nullptr;
    }

    Closed of(const Child& child) const {
        const bool any =
            ((edges_closed & child.rule_edges) | (faces_closed & child.rule_faces)) != 0;
        return {any, &child, edge.data(), face.data()};
    }
};

template <class Grid, class Field, Needs needs>
template <class Visitor>
#if defined(__GNUC__)
[[gnu::noinline]]  // its frame is large, and grids that conform never come here
#endif
void Traversal<Grid, Field, needs>::close_and_enter(const State& s, const Rule& rule,
                                                    const Nodes& nodes, Visitor& visitor) const {
    Parts parts;
    close(s, rule, nodes, parts);
    enter(s, rule, nodes, &parts, visitor);
}

template <class Grid, class Field, Needs needs>
void Traversal<Grid, Field, needs>::close(const State& s, const Rule& rule, const Nodes& nodes,
                                          Parts& parts) const {
    if constexpr (needs.closed) {
        using Closed = typename State::Closed;
        const Topology& t = s.topology();
        const auto corners = static_cast<std::size_t>(s.corner_count());
        if (rule.edges.size() > Parts::edges) {
            throw GridError("rule '" + rule.name + "' has too many edges for this grid");
        }
        if constexpr (!State::carries_keys) keys(s, std::span<NodeKey>(nodes.key, corners));
        parts.split.key = nodes.key;
        parts.split.new_key = nodes.key + corners;
        parts.split.element = &s;
        parts.split.rule = &rule;
        parts.split.value = nodes.value.data();
        parts.split.places = nullptr;
        if constexpr (State::carries_positions) {
            if (!own_positions_) parts.split.places = nodes.position.data();
        }
        // Which ones are closed nobody can predict: they are chosen without branches.
        for (std::size_t e = 0; e < rule.edges.size(); ++e) {
            const RuleEdge& edge = rule.edges[e];
            parts.closed_edge[e] = {&parts.split, edge.end};
            const typename Closed::Edge* outer = e < t.edges ? s.closed.edge(e) : nullptr;
            const typename Closed::Edge* own = edge.inner != 0 ? &parts.closed_edge[e] : nullptr;
            const bool divided = (edge.inner & ~nodes.mean) != 0;
            const std::array around{outer != nullptr ? outer : own,
                                    static_cast<const typename Closed::Edge*>(nullptr)};
            parts.edge[e] = around[divided];
            parts.edges_closed |= std::uint32_t{parts.edge[e] != nullptr} << e;
        }
        for (std::size_t f = 0; f < rule.faces.size(); ++f) {
            const RuleFace& face = rule.faces[f];
            const ClosedFace* outer =
                face.parent != no_face ? parts.face[face.parent] : s.closed.face(f);
            parts.closed_face[f] = {outer, &face, &parts.split};
            const bool closes = face.divided && (face.inner & ~nodes.mean) == 0;
            const std::array around{outer, std::as_const(parts.closed_face).data() + f};
            parts.face[f] = around[closes];
            parts.faces_closed |= std::uint32_t{parts.face[f] != nullptr} << f;
        }
    }
}

template <class Grid, class Field, Needs needs>
auto Traversal<Grid, Field, needs>::positions(const typename State::Closed::Edge& edge) const
    -> std::array<Point, 2>
    requires(needs.closed)
{
    const auto& split = *edge.split;
    if (split.places != nullptr) return {split.places[edge.end[0]], split.places[edge.end[1]]};
    const auto corners = static_cast<std::size_t>(split.element->corner_count());
    std::array<Point, node_capacity_> x;
    positions(*split.element, x);
    const std::size_t last = std::max(edge.end[0], edge.end[1]);
    for (std::size_t n = corners; n <= last; ++n) {
        const bool asked = n == edge.end[0] || n == edge.end[1];
        if (!asked && split.rule->steps == 1) continue;  // no parent of another new node
        x[n] = detail::interpolate(split.rule->new_nodes[n - corners], x.data());
    }
    return {x[edge.end[0]], x[edge.end[1]]};
}

}  // namespace nestgrid
