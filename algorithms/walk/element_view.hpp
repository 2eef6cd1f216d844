// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// An element as a walk shows it, with pointers into the family and the frame that it belongs to.
#pragma once

#include <nestgrid/hierarchy.hpp>
#include <walk/closed_parts.hpp>

namespace nestgrid::engine {

template <class Real>
class WalkStack;

/// What a walk carries of the nodes of an element's father.
struct FatherNodes {
    const NodeKey* key;     ///< where the walk carries keys
    const Point* position;  ///< where it carries positions
    const Point* placed;    ///< where the grid has the nodes, where the walk carries this
};

/// An element on the way down. A view is valid while the walk is at the element or below it.
template <class Real>
struct ElementView {
    const Member* member;       ///< handle, rule and masks of the element
    const Family* family;       ///< the family that the member belongs to
    WalkStack<Real>* stack;     ///< the memory of the walk
    std::size_t coarse;         ///< number of the coarse element above it
    const ElementView* father;  ///< null for a coarse element
    const Rule* made_by;        ///< the father's rule; null for a coarse element
    const Child* as;            ///< the element in that rule; null for a coarse element
    /// P_S U at the corners: component c of corner k at value[k * components + c].
    const Real* value;
    FatherNodes nodes;
    NodeKey path;              ///< a hash of the way down
    ClosedParts<Real> closed;  ///< edges and faces around the element that are closed
    int level;                 ///< 0 for coarse elements
    Shape shape;
    std::int8_t orientation;
    std::uint8_t child;         ///< number of the element in the father's rule
    std::uint8_t boundary;      ///< faces on the boundary of the domain, one bit each
    std::uint8_t interpolated;  ///< corners whose value is interpolated by S, one bit each

    const Topology& topology() const { return nestgrid::topology(shape); }
    std::size_t corner_count() const { return topology().corners; }
    bool is_leaf() const { return member->rule == nullptr; }
    const Handle& element() const { return member->element; }
    InnerBounds inner_bounds() const { return family->inner_bounds(*member); }
};

}  // namespace nestgrid::engine
