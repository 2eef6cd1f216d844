// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/hierarchy.hpp>
#include <ranks/shared_nodes.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The hanging nodes of a hierarchy, by hanging_probe.hpp, with its crossing nodes where it gives
/// parents (crossing_nodes.hpp). Hidden leaves constrain no node.
/// \throw GridError where refinement is anisotropic, and nodes hang on others than their parents,
///        which the grid does not give; where a node hangs on two edges in two directions; or
///        where it hangs on an edge and is not in its middle
template <class Real>
HangingNodes derive_hanging_nodes(const Hierarchy<Real>& hierarchy);

/// Whether the hanging nodes must be derived: the grid is not conforming, and does not name them,
/// or gives their parents.
template <class Real>
bool hanging_nodes_unknown(const Hierarchy<Real>& hierarchy) {
    return (!hierarchy.offers(Feature::constrained) ||
            hierarchy.offers(Feature::hanging_parents)) &&
           !hierarchy.facts().conforming;
}

/// Finds the nodes of hidden leaves alone, or of no leaf, in a walk that carries keys.
class UnseenSearch {
public:
    explicit UnseenSearch(std::size_t node_count) : met_(node_count), seen_(node_count) {}

    /// Takes an element, each once.
    /// \param shown whether it is a leaf that is drawn
    template <class Real>
    void add(const Walk<Real>& walk, const ElementView<Real>& view, const Split& split,
             bool shown) {
        for (const NodeKey key : split.keys) met_.insert(key);
        if (!shown && view.level > 0) return;
        std::array<NodeKey, max_corners> keys;
        walk.corners(view, keys.data(), nullptr);
        for (const NodeKey key : std::span(keys).first(view.corner_count())) {
            if (shown) seen_.insert(key);
            if (view.level == 0) met_.insert(key);
        }
    }
    NodeSet found() const { return met_.without(seen_); }

private:
    NodeSet met_;
    NodeSet seen_;
};

/// Sets the nodes of hidden leaves alone, or of no leaf: those that holes know, else walks once.
template <class Real>
void find_unseen_nodes(const Hierarchy<Real>& hierarchy, HangingNodes& nodes);

/// The hanging nodes that a walk must be told: those derived where they are unknown, else none; and
/// the nodes of hidden leaves alone.
/// \throw GridError as derive_hanging_nodes()
template <class Real>
HangingNodes find_hanging_nodes(const Hierarchy<Real>& hierarchy) {
    if (hierarchy.facts().shared != nullptr) return hierarchy.facts().shared->hanging();
    HangingNodes nodes;
    if (hanging_nodes_unknown(hierarchy)) nodes = derive_hanging_nodes(hierarchy);
    if (hierarchy.offers(Feature::hidden)) find_unseen_nodes(hierarchy, nodes);
    return nodes;
}

}  // namespace nestgrid::engine
