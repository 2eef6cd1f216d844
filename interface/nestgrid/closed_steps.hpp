// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which edges and faces a split closes; included by traversal.hpp.
#pragma once

#include <algorithm>
#include <bit>

#include <nestgrid/traversal.hpp>

namespace nestgrid {

template <class Grid, class Field, Needs needs>
struct Traversal<Grid, Field, needs>::Parts {
    using Closed = typename State::Closed;
    static constexpr std::size_t edges = Closed::rule_edges;

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
        const Topology& t = s.topology();
        const auto corners = static_cast<std::size_t>(s.corner_count());
        if (rule.edges.size() > Parts::edges) {
            throw GridError("rule '" + rule.name + "' has too many edges for this grid");
        }
        std::array<NodeKey, max_corners> corner_key;
        keys(s, corner_key);
        const auto key = [&](std::uint8_t n) { return n < corners ? corner_key[n] : nodes.key[n]; };
        const Point* places = nullptr;
        if constexpr (State::carries_positions) {
            if (!own_positions_) places = nodes.position.data();
        }
        for (std::size_t e = 0; e < rule.edges.size(); ++e) {
            const RuleEdge& edge = rule.edges[e];
            parts.edge[e] = e < t.edges ? s.closed.edge(e) : nullptr;
            if ((edge.inner & ~nodes.mean) != 0) {
                parts.edge[e] = nullptr;
            } else if (parts.edge[e] == nullptr && edge.inner != 0) {
                auto& closed = parts.closed_edge[e];
                closed.end = edge.end;
                closed.element = &s;
                closed.rule = &rule;
                closed.places = places;
                for (std::size_t i = 0; i < 2; ++i) {
                    closed.key[i] = key(edge.end[i]);
                    for (std::size_t c = 0; c < State::components; ++c) {
                        closed.value[i * State::components + c] =
                            nodes.value[edge.end[i] * State::components + c];
                    }
                }
                parts.edge[e] = &closed;
            }
            parts.edges_closed |= std::uint32_t{parts.edge[e] != nullptr} << e;
        }
        for (std::size_t f = 0; f < rule.faces.size(); ++f) {
            const RuleFace& face = rule.faces[f];
            parts.face[f] = face.parent != no_face ? parts.face[face.parent] : s.closed.face(f);
            parts.faces_closed |= std::uint32_t{parts.face[f] != nullptr} << f;
            if (!face.divided || (face.inner & ~nodes.mean) != 0) continue;
            std::array<NodeKey, 4> loop;
            for (std::size_t i = 0; i < face.corners; ++i) loop[i] = key(face.corner[i]);
            const std::span<const NodeKey> of(loop.data(), face.corners);
            NodeKey divided_by = 0;
            for (NodeMask left = face.one_way ? face.first : 0; left != 0; left &= left - 1) {
                divided_by += detail::mix(key(static_cast<std::uint8_t>(
                    corners + static_cast<std::size_t>(std::countr_zero(left)))));
            }
            parts.closed_face[f] = {face_key(of), parts.face[f], divided_by};
            parts.face[f] = &parts.closed_face[f];
            parts.faces_closed |= std::uint32_t{1} << f;
        }
    }
}

template <class Grid, class Field, Needs needs>
auto Traversal<Grid, Field, needs>::positions(const typename State::Closed::Edge& edge) const
    -> std::array<Point, 2>
    requires(needs.closed)
{
    if (edge.places != nullptr) return {edge.places[edge.end[0]], edge.places[edge.end[1]]};
    const auto corners = static_cast<std::size_t>(edge.element->corner_count());
    std::array<Point, node_capacity_> x;
    positions(*edge.element, x);
    const std::size_t last = std::max(edge.end[0], edge.end[1]);
    for (std::size_t n = corners; n <= last; ++n) {
        const bool asked = n == edge.end[0] || n == edge.end[1];
        if (!asked && edge.rule->steps == 1) continue;  // no parent of another new node
        x[n] = detail::interpolate(edge.rule->new_nodes[n - corners], x.data());
    }
    return {x[edge.end[0]], x[edge.end[1]]};
}

}  // namespace nestgrid
