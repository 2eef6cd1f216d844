// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a walk does on a grid with crossing nodes (crossing_nodes.hpp): it takes the values and
// positions of fixed nodes from here, and the closed parts (closed_parts.hpp) around edges and
// faces that have a crossing node.
//
// An edge that begins at a crossing node is a part of the edge on which this node hangs, and a face
// with a crossing node is a part of the face whose edges its nodes halve. Elements on the other
// side have these for edges and faces, and no element above the one at hand has. So they are found
// by key: where one end of an edge hangs between the other end and a third node, the edge is a part
// of the one between these; and so on.
#pragma once

#include <array>
#include <deque>
#include <vector>

#include <walk/closed_parts.hpp>
#include <walk/position_functions.hpp>
#include <walk/visitor.hpp>

namespace nestgrid::engine {

class CrossingNodes;

/// A closed face found by key: no ancestor of the current element has it as a face.
class CrossedFace {
public:
    /// \param corner, halving keys of the corners and of the nodes that halve it first
    CrossedFace(const std::array<NodeKey, 4>& corner, const std::array<NodeKey, 2>& halving)
        : corner_{corner}, halving_{halving}, nodes_{corner_.data(), halving_.data()} {}
    CrossedFace(const CrossedFace&) = delete;
    CrossedFace& operator=(const CrossedFace&) = delete;
    ~CrossedFace() = default;

private:
    static constexpr RuleFace halved_{.corners = 4,
                                      .corner = {0, 1, 2, 3},
                                      .divided = true,
                                      .inner = 3,
                                      .first = 3,
                                      .one_way = true};
    std::array<NodeKey, 4> corner_;
    std::array<NodeKey, 2> halving_;
    ClosingNodes nodes_;

public:
    ClosedFace face{nullptr, &halved_, &nodes_};
};

/// Owns the closed edges and faces found by key. Addresses stay valid until clear().
template <class Real>
struct CrossedParts {
    std::deque<MaximalEdge<Real>> edges;
    std::deque<CrossedFace> faces;

    void clear() {
        edges.clear();
        faces.clear();
    }
};

/// The parts around a split with crossing nodes, and around the child that the walk is at.
template <class Real>
struct CrossedSplit {
    CrossedParts<Real> of_rule;
    CrossedParts<Real> of_child;
    // What ClosedParts looks up: each edge and face of the child has a place of its own.
    Child child;
    std::array<const MaximalEdge<Real>*, max_rule_edges + 1> around_edge;
    std::array<const ClosedFace*, max_rule_faces + 1> around_face;
};

/// The fixed nodes of one walk.
template <class Real>
class FixedNodes {
public:
    /// \param with_values whether the walk has values; asks the field for them
    /// \param functions that the first components are, or null
    /// \throw GridError where the field has no value at a fixed node that does not hang
    FixedNodes(const Hierarchy<Real>& hierarchy, const CrossingNodes& crossing, bool with_values,
               const PositionFunctions* functions);
    FixedNodes(const FixedNodes&) = delete;
    FixedNodes& operator=(const FixedNodes&) = delete;
    ~FixedNodes() = default;

    const CrossingNodes& crossing() const { return *crossing_; }
    /// Which of these nodes are fixed, one bit each.
    NodeMask mask(std::span<const NodeKey> keys) const;
    /// Puts the values of crossing nodes behind those of the corners.
    /// \param value of the first new node
    void put_values(const Split& split, Real* value) const;
    /// Puts the functions of position at one fixed node.
    void put_functions(NodeKey key, Real* out) const;
    /// Puts the positions of fixed nodes where those of the new nodes are.
    /// \return these nodes, one bit each
    NodeMask put_positions(std::span<const NodeKey> keys, Point* x) const;

    /// Corrects what a split closes around those parts of its rule's faces that have crossing
    /// nodes. \param mean new nodes whose value is the mean of their parents in the rule
    void close_parts(const Split& split, NodeMask mean, ClosingSplit<Real>& closing,
                     CrossedSplit<Real>& crossed) const;
    /// The closed parts around a child.
    ClosedParts<Real> around(const Split& split, const ClosingSplit<Real>& closing,
                             const Child& child, CrossedSplit<Real>& crossed) const;

private:
    const MaximalEdge<Real>* around_edge(std::array<NodeKey, 2> edge,
                                         CrossedParts<Real>& parts) const;
    const ClosedFace* around_face(std::array<NodeKey, 4> corner, CrossedParts<Real>& parts) const;

    const CrossingNodes* crossing_;
    std::size_t components_;
    std::size_t function_count_;
    // By number of the fixed node.
    std::vector<Real> value_;
    std::vector<NodeKey> key_;
    std::vector<Point> position_;
    typename MaximalEdge<Real>::Split nodes_{};
};

}  // namespace nestgrid::engine
