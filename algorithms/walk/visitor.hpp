// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What an algorithm tells a walk: where to go, and what to do with the elements it extracts.
#pragma once

#include <cstdint>
#include <span>

#include <walk/element_view.hpp>
#include <walk/visit.hpp>

namespace nestgrid::engine {

/// A visitor's answer about one element.
struct Decision {
    Visit visit = Visit::descend;
    NodeMask interpolated = 0;  ///< new nodes at which the criterion S holds
    /// S at each new node, in [0, 1] and 1 where `interpolated` says so; empty where S has no other
    /// values than 0 and 1. Read before the visitor is asked again.
    std::span<const float> weights{};
};

/// The refinement of an element; `rule` is null on a leaf.
struct Split {
    const Rule* rule = nullptr;
    NodeMask constrained = 0;       ///< new nodes that hang, and those of hidden leaves alone
    NodeMask unseen = 0;            ///< new nodes of hidden leaves alone
    NodeMask outside = 0;           ///< see the operation `outside`
    NodeMask crossing = 0;          ///< new nodes that no stencil of the rule gives a value
    std::span<const NodeKey> keys;  ///< of the new nodes, where the walk needs keys
};

/// Children of one element that are leaves, one bit each.
struct Leaves {
    NodeMask extract = 0;  ///< to be extracted without inspect()
    NodeMask inspect = 0;  ///< to be inspected like other elements
};

/// Decides about elements and takes those that are extracted. The walk calls, for each element in
/// depth-first order, inspect(), and then extract(), or entered() followed by the children, or
/// nothing. Elements whose split makes no node (copies) are looked through: inspect() is not
/// called.
template <class Real>
class Visitor {
public:
    virtual Decision inspect(const ElementView<Real>& view, const Split& split) = 0;
    /// Called for elements where inspect() said stop, and for leaves it did not skip.
    virtual void extract(const ElementView<Real>& view) = 0;

    /// Called when an element is about to be entered.
    /// \param values P_S U at the corners and, behind them, at the new nodes
    virtual void entered(const ElementView<Real>& /*view*/, const Split& /*split*/,
                         const Real* /*values*/) {}
    /// The children that are to be entered, one bit each, where inspect() said descend.
    virtual NodeMask children(const ElementView<Real>& /*view*/) { return ~NodeMask{0}; }
    /// Decides at once about all children that are leaves.
    /// \param values P_S U at the corners and, behind them, at the new nodes of the father
    /// \param which the children that are leaves and are shown
    /// \param closed whether the father's split closed anything around them
    virtual Leaves leaves(const Rule& /*rule*/, const Real* /*values*/, NodeMask which,
                          bool /*closed*/) {
        return {0, which};
    }
    /// Whether the visitor looks at hidden elements.
    virtual bool sees_hidden() const { return false; }
    /// Takes an element and all below it in a walk of its own. \return whether it did
    virtual bool takes(const ElementView<Real>& /*view*/) { return false; }

protected:
    Visitor() = default;
    ~Visitor() = default;
    Visitor(const Visitor&) = default;
    Visitor& operator=(const Visitor&) = default;
    Visitor(Visitor&&) noexcept = default;
    Visitor& operator=(Visitor&&) noexcept = default;
};

}  // namespace nestgrid::engine
