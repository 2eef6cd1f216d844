// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include <nestgrid/detail/node_set.hpp>

namespace nestgrid {

namespace engine {
class CrossingNodes;
}

/// The nodes of a grid that hang: that lie on an edge or face of some leaf without being a corner
/// of it. A property of the node, the same from every element. Filled by derive_hanging_nodes().
/// Beside them, the nodes that no leaf has that is drawn.
class HangingNodes {
public:
    void insert(NodeKey key) { hanging_.insert(key); }
    bool contains(NodeKey key) const { return hanging_.contains(key); }
    std::size_t size() const { return hanging_.size(); }
    std::size_t memory_bytes() const { return hanging_.memory_bytes() + unseen_.memory_bytes(); }
    bool empty() const { return size() == 0 && unseen_.empty() && crossing_ == nullptr; }

    /// Which of the keys hang, one bit each.
    NodeMask mask(std::span<const NodeKey> keys) const { return hanging_.mask(keys); }

    /// Nodes of hidden leaves alone, or of none in the domain. Nobody asks for their values: new
    /// nodes are interpolated, and corners of the coarse grid are 0, so that nothing depends on
    /// what a field has there.
    void set_unseen(NodeSet nodes) { unseen_ = std::move(nodes); }
    bool any_unseen() const { return !unseen_.empty(); }
    /// Which of the keys are those of such nodes, one bit each.
    NodeMask unseen(std::span<const NodeKey> keys) const { return unseen_.mask(keys); }

    /// Nodes that have several stencils, on grids that give parents (optional.hpp); or null.
    const engine::CrossingNodes* crossing() const { return crossing_.get(); }
    void set_crossing(std::shared_ptr<const engine::CrossingNodes> nodes) {
        crossing_ = std::move(nodes);
    }

private:
    NodeSet hanging_;
    NodeSet unseen_;
    std::shared_ptr<const engine::CrossingNodes> crossing_;
};

}  // namespace nestgrid
