// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Updates a preroll where the field or the grid has changed.
//
// Stop and bound of a node are maxima over finer nodes. So a node is *dirty*, that is its entry may
// be wrong, where its own offset may have changed, where it is a corner of a split that makes a
// dirty node (or a parent of one), and where it lies inside an element whose split makes one. All
// other entries are right as they are: every node below them is clean. A dirty entry begins anew,
// and takes its maxima over the splits that have a dirty corner.
#pragma once

#include <indicators/sweeps.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The dirty nodes of a hierarchy.
class DirtyNodes {
public:
    /// Finds the dirty nodes: walks down where something has changed or a corner is dirty, until
    /// no more are found.
    /// \param walk must carry keys and positions
    /// \param refined whether the grid may have changed, and not only values
    template <class Real>
    DirtyNodes(const Walk<Real>& walk, const ChangedPlaces& changed, bool refined);

    bool contains(NodeKey node) const { return state_.find(node) != nullptr; }
    bool any(std::span<const NodeKey> nodes) const {
        return std::ranges::any_of(nodes, [&](NodeKey node) { return contains(node); });
    }

private:
    struct State {
        bool moved = false;  // the value at the node, which hangs, may have changed
    };
    template <class Real>
    class Marker;

    KeyTable<NodeKey, State> state_;
};

/// Computes the entries of dirty nodes anew, and calls put(node, entry) for each.
/// \param walk must carry values and keys
/// \param leaf_errors empty where leaves have none
/// \param spread how `stop` is handed from finer nodes to coarser ones; the walk must carry
///        positions where its slope is not 0
/// \return facts about the elements with dirty corners
/// \throw InvalidInput where a value or an error is not usable; put() was not called then
template <class Real>
detail::PrerollFacts sweep_dirty(const Walk<Real>& walk, const DirtyNodes& dirty,
                                 const detail::IndicatorEntries& entries,
                                 const LeafErrors& leaf_errors, const Spread& spread,
                                 const std::function<void(NodeKey, detail::IndicatorEntry)>& put);

}  // namespace nestgrid::engine
