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
// They live in the frames of the splits that closed them, and refer to the nodes there: valid while
// the element is on the stack.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include <nestgrid/keys.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// Key of a face from those of its corners, in any order. Own keys may be small numbers, whose sums
/// coincide, so each is mixed first.
class FaceKey {
public:
    constexpr void add_corner(NodeKey key) { add_mixed(detail::mix(key)); }
    /// \param mixed of a corner that several faces have: mix() of its key
    constexpr void add_mixed(NodeKey mixed) { sum_ += mixed; }
    constexpr NodeKey key() const { return detail::mix(sum_); }

private:
    NodeKey sum_ = 0;
};

/// The nodes of a split that closed something.
struct ClosingNodes {
    const NodeKey* key;      ///< by number in the rule: corners first
    const NodeKey* new_key;  ///< those of the new nodes
};

/// An edge with its two ends, nodes of the split that closed it.
/// \tparam State of an element on the way down
template <class State, class Real, std::size_t components>
struct MaximalEdge {
    struct Split : ClosingNodes {
        const State* element;  ///< that was split
        const Rule* rule;
        const Real* value;    ///< component c of node n at [n * components + c]
        const Point* places;  ///< where they are carried along; or null
    };

    const Split* split;
    std::array<std::uint8_t, 2> end;

    NodeKey key(std::size_t i) const { return split->key[end[i]]; }
    Real value(std::size_t i, std::size_t component) const {
        return split->value[end[i] * components + component];
    }
};

struct ClosedFace {
    const ClosedFace* outer;  ///< the least closed face it is a proper part of, or null
    const RuleFace* face;     ///< in the rule of the split that closed it
    const ClosingNodes* nodes;

    NodeKey key() const {
        FaceKey k;
        for (std::size_t i = 0; i < face->corners; ++i) k.add_corner(nodes->key[face->corner[i]]);
        return k.key();
    }
    /// Which nodes divide it, where it is divided one way; or 0.
    NodeKey divided_by() const {
        NodeKey sum = 0;
        for (NodeMask left = face->one_way ? face->first : 0; left != 0; left &= left - 1) {
            sum += detail::mix(nodes->new_key[std::countr_zero(left)]);
        }
        return sum;
    }
};

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
