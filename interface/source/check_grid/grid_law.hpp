// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A law of check_grid, and what it is shown of a hierarchy.
//
// The walk (checking_walk.hpp) shows the coarse elements; then each element from the top down, and
// the nodes that it makes; then each element again. Laws look at what they are shown, and know
// nothing of each other: a new one is a class in a source file, and a line in laws.hpp and in
// check_grid.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::detail {

/// Whether a member of a family lies outside of what the grid shows.
inline bool is_masked(const Family& family, std::size_t member) {
    return ((family.split | family.leaves) >> member & 1U) == 0;
}

/// A corner or a new node of an element.
struct CheckedNode {
    /// Over the corners of the coarse element.
    std::array<double, max_corners> weights{};
    NodeKey place = 0;  ///< hash of the weights over coarse ids
    NodeKey key = 0;    ///< the grid's own one, where it has such; else the derived one
    /// By the rules, from the corners of the coarse element. When elements are shown again: in
    /// reference coordinates of the coarse element.
    Point position{};
    double value = 0;  ///< of component 0
};

struct CheckedElement {
    const Member* member;
    const Family* family;  ///< that it is a member of
    Shape shape;
    std::size_t step;    ///< names it: Inspection::name()
    std::size_t coarse;  ///< number of the coarse element that it lies in
    double coarse_size;  ///< greatest distance of that one's corner 0 from another corner
    int level;
    std::array<CheckedNode, max_corners> corner;

    std::span<const CheckedNode> corners() const {
        return std::span(corner).first(topology(shape).corners);
    }
    bool is_leaf() const { return member->rule == nullptr; }
};

/// An element with its children.
struct CheckedSplit {
    const CheckedElement& father;
    const Rule& rule;
    const Family& children;
    /// Corners and new nodes, in the order of the rule.
    std::span<const CheckedNode> nodes;
};

/// A corner of a coarse element, or a new node of an element.
struct MadeNode {
    const CheckedElement& element;
    std::size_t number;                  ///< in the element: corners first
    std::span<const CheckedNode> nodes;  ///< of the element
    const Stencil* stencil;              ///< over these; null at the corner of a coarse element
    bool has_value;                      ///< else the values below say nothing
    std::span<const double> values;      ///< of all components
    bool constrained;                    ///< whether the grid says that the node hangs
    std::size_t known;                   ///< its number in KnownNodes
    bool is_new;                         ///< whether no element has made it before

    const CheckedNode& node() const { return nodes[number]; }
};

class GridLaw {
public:
    GridLaw() = default;
    GridLaw(const GridLaw&) = delete;
    GridLaw& operator=(const GridLaw&) = delete;
    virtual ~GridLaw() = default;

    /// Each coarse element, before all others.
    /// \param i its number
    virtual void visit(const Coarse& /*coarse*/, std::size_t /*i*/) {}
    virtual void finish_coarse() {}

    /// Each element, before it is asked for its children.
    virtual void visit(const CheckedElement& /*element*/) {}
    /// Each element with children, before these.
    virtual void visit(const CheckedSplit& /*split*/) {}
    /// Each node that an element makes, after its split and in the order of the rule.
    virtual void visit(const MadeNode& /*made*/) {}
    /// When all elements have been shown once.
    virtual void finish() {}

    /// Each element once more, in the same order.
    virtual void revisit(const CheckedElement& /*element*/) {}
};

}  // namespace nestgrid::detail
