// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Closed edges and faces: those that a split divides although P_S U does not change on them,
// because every new node on them is interpolated or hangs. An element on their other side may have
// stopped above the division.
//
// Invariants, for an element on the way down:
//   - closed.edge(e) is the maximal edge around edge e: the longest one on which all nodes are
//     interpolated; or null, where that is the edge itself;
//   - closed.face(f) is the least closed face that face f is a proper part of, or null;
//     `outer` leads from it to the greater ones.
// Consequence: a cut is named by, and computed from, its maximal edge, so that elements on both
// sides of a change of level find the same; and what is drawn below a closed face can be told to
// the element above it, by the key of the face.
// Closed parts lie in the frame of the split that closed them and refer to the nodes there: they
// are valid while the walk is below that split.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <nestgrid/keys.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid::engine {

template <class Real>
struct ElementView;

/// Key of a face from the keys of its corners, in any order. Own keys may be small numbers whose
/// sums coincide, so each key is mixed first.
class FaceKey {
public:
    constexpr void add_corner(NodeKey key) { add_mixed(detail::mix(key)); }
    /// \param mixed mix() of the key of a corner, for corners of several faces
    constexpr void add_mixed(NodeKey mixed) { sum_ += mixed; }
    constexpr NodeKey key() const { return detail::mix(sum_); }

private:
    NodeKey sum_ = 0;
};

/// The nodes of a split that closed something.
struct ClosingNodes {
    const NodeKey* key;      ///< by number in the rule, corners first
    const NodeKey* new_key;  ///< of the new nodes
};

/// An edge whose two ends are nodes of the split that closed it.
template <class Real>
struct MaximalEdge {
    struct Split : ClosingNodes {
        const ElementView<Real>* element;  ///< the element that was split
        const Rule* rule;
        const Real* value;  ///< component c of node n at [n * components + c]
        std::size_t components;
        const Point* places;  ///< positions of the nodes where the walk carries them, or null
    };

    const Split* split;
    std::array<std::uint32_t, 2> end;

    NodeKey key(std::size_t i) const { return split->key[end[i]]; }
    Real value(std::size_t i, std::size_t component) const {
        return split->value[end[i] * split->components + component];
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
    /// A hash of the nodes that divide the face, where it is divided one way; else 0.
    NodeKey divided_by() const {
        NodeKey sum = 0;
        for (NodeMask left = face->one_way ? face->first : 0; left != 0; left &= left - 1) {
            sum += detail::mix(nodes->new_key[std::countr_zero(left)]);
        }
        return sum;
    }
};

/// The closed parts around the edges and faces of an element.
template <class Real>
struct ClosedParts {
    bool any;            ///< where false, nothing else is set but any_face, which is false, too
    bool any_face;       ///< whether there is a closed face
    const Child* child;  ///< the element in the rule that made it
    /// Around the edges of that rule and around parts of its faces; null behind the last one.
    const MaximalEdge<Real>* const* around_edge;
    const ClosedFace* const* around_face;

    const MaximalEdge<Real>* edge(std::size_t e) const {
        if (!any) return nullptr;
        return around_edge[std::min<std::size_t>(child->rule_edge[e], max_rule_edges)];
    }
    const ClosedFace* face(std::size_t f) const {
        if (!any) return nullptr;
        return around_face[std::min<std::size_t>(child->rule_face[f], max_rule_faces)];
    }
};

/// The edges and faces of a rule that one split closes.
template <class Real>
struct ClosingSplit {
    typename MaximalEdge<Real>::Split split;
    std::array<MaximalEdge<Real>, max_rule_edges> closed_edge;
    /// Around each edge of the rule.
    std::array<const MaximalEdge<Real>*, max_rule_edges + 1> edge;
    std::array<ClosedFace, max_rule_faces> closed_face;
    /// Around parts of each face of the rule.
    std::array<const ClosedFace*, max_rule_faces + 1> face;
    std::uint32_t edges_closed = 0;  ///< edges around which there is a maximal edge, one bit each
    std::uint32_t faces_closed = 0;

    /// Sets everything but `split`, which must be set before.
    /// \param mean new nodes whose value is the mean of their parents
    void close(const ElementView<Real>& view, const Rule& rule, NodeMask mean);

    ClosedParts<Real> around(const Child& child) const {
        const bool any_face = (faces_closed & child.rule_faces) != 0;
        const bool any = any_face || (edges_closed & child.rule_edges) != 0;
        return {any, any_face, &child, edge.data(), face.data()};
    }
};

}  // namespace nestgrid::engine
