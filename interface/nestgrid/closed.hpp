// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Closed edges and faces: those that a split divides although P_S U does not change on them, for
// every new node on them is interpolated or hangs. An element on their other side may have stopped
// above the division.
//
// Invariants, for an element on the way down:
//   - closed.edge(e) is the maximal edge around edge e: the longest one on which all nodes are
//     interpolated; or null, where that is the edge itself;
//   - closed.face(f) is the least closed face that face f is a proper part of, or null;
//     `outer` leads from it to the greater ones.
// Consequence: a cut is named by, and computed from, its maximal edge, so that elements on both
// sides of a change of level find the same; and what is drawn below a closed face can be told to
// the element above it, by the key of the face.
// They live in the frames of the splits that closed them: valid while the element is on the stack.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <nestgrid/keys.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// An edge with its two ends; component c of the value at end i is value[i * components + c].
/// \tparam State of an element on the way down
template <class State, class Real, std::size_t components>
struct MaximalEdge {
    std::array<NodeKey, 2> key;
    std::array<Real, 2 * components> value;
    std::array<std::uint8_t, 2> end;  ///< nodes of the split that closed it
    const State* element;             ///< that was split
    const Rule* rule;
    const Point* places;  ///< of the nodes of that split, where they are carried along; or null
};

struct ClosedFace {
    NodeKey key;              ///< face_key() of its corners
    const ClosedFace* outer;  ///< the least closed face it is a proper part of, or null
    NodeKey split;            ///< which nodes divide it, where it is divided one way; or 0
};

/// Key of a face from those of its corners, in any order. Own keys may be small numbers, whose sums
/// coincide, so each is mixed first.
constexpr NodeKey face_key(std::span<const NodeKey> corners) {
    NodeKey sum = 0;
    for (const NodeKey key : corners) sum += detail::mix(key);
    return detail::mix(sum);
}

/// What is closed around the edges and faces of an element.
template <class State, class Real, std::size_t components, std::size_t corners>
struct ClosedParts {
    using Edge = MaximalEdge<State, Real, components>;
    static constexpr std::size_t edges = corners == 3 ? 3 : corners <= 4 ? 6 : max_edges;
    static constexpr std::size_t rule_edges = corners <= 4 ? 12 : max_rule_edges;

    bool any;            ///< otherwise nothing else is set
    const Child* child;  ///< the element in the rule that made it
    /// Around the edges of that rule and around parts of its faces; behind them null.
    const Edge* const* around_edge;
    const ClosedFace* const* around_face;

    const Edge* edge(std::size_t e) const {
        static_assert(no_edge >= rule_edges);
        return any ? around_edge[std::min<std::size_t>(child->rule_edge[e], rule_edges)] : nullptr;
    }
    const ClosedFace* face(std::size_t f) const {
        static_assert(no_face >= max_rule_faces);
        if (!any) return nullptr;
        return around_face[std::min<std::size_t>(child->rule_face[f], max_rule_faces)];
    }
};

}  // namespace nestgrid
