// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Refinement rules as data (paper, section 1.2 and eq. (1)).
//
// The nodes of a rule are numbered: first the corners of the parent, then the new nodes in order.
// Invariants, asserted by find_violation():
//   - the weights of every stencil are positive and sum to one, and name earlier nodes only;
//   - every child lies inside the parent and has positive volume under its orientation sign;
//   - every face of a child lies in a face of the parent, or belongs to two children on its two
//     sides;
//   - the volumes of the children add up to that of the parent;
//   - where there are new nodes, every child has one for a corner: what saturates a function of the
//     nodes goes from a child to its father by it.
// Consequence: the children tile the parent, no node hangs inside one split, and every corner of
// the parent is a corner of a child.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// A set of new nodes of one rule: bit i stands for new node i.
using NodeMask = std::uint64_t;

inline constexpr int max_new_nodes = 64;
inline constexpr int max_children = 64;
inline constexpr std::uint8_t no_face = 0xFF;
inline constexpr std::uint8_t no_edge = 0xFF;
inline constexpr std::uint8_t no_child = 0xFF;
inline constexpr std::uint8_t no_new_node = 0xFF;
inline constexpr int max_rule_edges = 24;
inline constexpr int max_rule_faces = 24;

/// How a stencil is summed; derived by make_rule from its parents and weights.
enum class Mean : std::uint8_t {
    midpoint,  ///< plain mean of two nodes
    face,      ///< plain mean of the corners of a quadrilateral, parents in tensor order
    cell,      ///< plain mean of eight nodes
    weighted,  ///< anything else
};

/// Where a new node lies: the weighted mean of its parents, eq. (1).
struct Stencil {
    std::uint8_t count = 0;
    std::array<std::uint8_t, max_corners> parent{};  ///< nodes of the rule, earlier than this one
    std::array<double, max_corners> weight{};
    std::uint8_t number = 0;  ///< tells apart stencils of equal parents and equal order of weights
    Mean mean = Mean::weighted;                    // derived
    std::array<std::uint8_t, max_corners> rank{};  // derived: 0 for the largest weight, and so on

    bool operator==(const Stencil&) const = default;
};

/// A child element: its shape and its corners as nodes of the rule.
struct Child {
    Shape shape = Shape::point;
    std::array<std::uint8_t, max_corners> corner{};
    std::int8_t orientation = 1;  ///< -1 where the corners are a mirror image of the parent's
    std::array<std::uint8_t, max_faces> parent_face{};  // derived: face of the parent, or no_face
    std::array<std::uint8_t, max_edges> rule_edge{};    // derived: the rule's edge it lies on
    std::array<std::uint8_t, max_faces> rule_face{};    // derived: the least of the rule's faces
                                                        // around it, or no_face
    std::uint32_t rule_edges = 0;                       // derived: all of rule_edge, one bit each
    std::uint32_t rule_faces = 0;                       // derived: all of rule_face, one bit each
    std::uint64_t nodes = 0;  // derived: all of corner, one bit each, where the rule has at most 64
                              // nodes, corners of the parent included; else 0
};

/// An edge of the parent; or one inside a face of it, whose middle node has its ends for parents:
/// an element that takes the steps of the rule one by one has it as an edge.
struct RuleEdge {
    std::array<std::uint8_t, 2> end{};  ///< nodes of the rule
    NodeMask inner = 0;                 ///< new nodes on it, its ends left out
};

/// A face of the parent, or one of the two parts into which an edge inside a face cuts that.
struct RuleFace {
    std::uint8_t corners = 0;
    std::array<std::uint8_t, 4> corner{};  ///< nodes of the rule, a loop as in FaceTopology
    std::uint8_t parent = no_face;         ///< of a part: the face of the parent it is cut from
    bool divided = false;                  ///< some child's face is a proper part of it
    NodeMask inner = 0;                    ///< new nodes in it, its corners left out
    NodeMask first = 0;                    ///< those of the first step, where there are several
    bool one_way = false;  ///< a quadrilateral that is first divided in one direction only
};

/// A corner of a child.
struct ChildCorner {
    std::uint8_t child = no_child;
    std::uint8_t corner = 0;
};

/// How an element is refined: its new nodes and its children. Made by make_rule.
struct Rule {
    std::string name;
    Shape parent = Shape::point;
    std::vector<Stencil> new_nodes;
    std::vector<Child> children;
    /// Derived: of which child each new node is a corner. The first one of a child where it can be,
    /// else the last one: in sorted leaves these are found without a search.
    std::vector<ChildCorner> new_corner{};
    /// Derived: of which child each corner of the parent is a corner.
    std::vector<ChildCorner> old_corner{};
    std::vector<RuleEdge> edges{};  // derived: first those of the parent, as in its topology
    std::vector<RuleFace> faces{};  // derived: those of the parent first; none in 2-d
    int steps = 1;  // derived: the longest chain of new nodes that are parents of each other
    std::uint8_t inside = no_new_node;  // derived: a new node in no face or edge of the parent, so
                                        // in no other element
    bool divides_all = false;  // derived: every edge and every face of the parent, the latter not
                               // one way
    bool divides_bare_faces = false;  // derived: some face is divided without a node in it

    int corner_count() const { return topology(parent).corners; }
    int new_node_count() const { return static_cast<int>(new_nodes.size()); }
    int child_count() const { return static_cast<int>(children.size()); }

    /// All new nodes.
    NodeMask all() const {
        return new_nodes.size() >= 64 ? ~NodeMask{0} : (NodeMask{1} << new_nodes.size()) - 1;
    }
};

/// Stencil of the plain mean of some nodes.
Stencil mean_of(std::initializer_list<int> parents);

/// Stencil with weights; `number` as in Stencil.
Stencil weighted_mean_of(std::initializer_list<std::pair<int, double>> parents, int number = 0);

/// Completes the derived members of a rule and checks it.
/// \throw InvalidInput with the sentence of find_violation().
Rule make_rule(std::string name, Shape parent, std::vector<Stencil> new_nodes,
               std::vector<Child> children);

/// The first violated invariant of the rule as a sentence, or nothing.
std::optional<std::string> find_violation(const Rule& rule);

/// Reference coordinates of all nodes of a rule, the parent's corners first.
std::vector<Point> reference_nodes(const Rule& rule);

}  // namespace nestgrid
