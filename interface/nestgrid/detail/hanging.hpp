// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include <nestgrid/detail/key_table.hpp>

namespace nestgrid {

namespace engine {
class CrossingNodes;
}

/// The nodes of a grid that hang: that lie on an edge or face of some leaf without being a corner
/// of it. A property of the node, the same from every element. Filled by derive_hanging_nodes().
/// Beside them, the nodes that no leaf has that is drawn.
class HangingNodes {
public:
    void insert(NodeKey key) { keys_.insert(key, {}); }
    bool contains(NodeKey key) const { return keys_.find(key) != nullptr; }
    std::size_t size() const { return keys_.size(); }
    std::size_t memory_bytes() const { return keys_.memory_bytes() + unseen_.memory_bytes(); }
    bool empty() const { return size() == 0 && unseen_.size() == 0 && crossing_ == nullptr; }

    /// Which of the keys hang, one bit each.
    NodeMask mask(std::span<const NodeKey> keys) const { return mask_in(keys_, keys); }

    /// Nodes of hidden leaves alone. Nobody asks for their values: new nodes are interpolated, and
    /// corners of the coarse grid are 0, so that nothing depends on what a field has there.
    void insert_unseen(NodeKey key) { unseen_.insert(key, {}); }
    bool any_unseen() const { return unseen_.size() > 0; }
    /// Which of the keys are those of such nodes, one bit each.
    NodeMask unseen(std::span<const NodeKey> keys) const { return mask_in(unseen_, keys); }

    /// Nodes that have several stencils, on grids that give parents (optional.hpp); or null.
    const engine::CrossingNodes* crossing() const { return crossing_.get(); }
    void set_crossing(std::shared_ptr<const engine::CrossingNodes> nodes) {
        crossing_ = std::move(nodes);
    }

private:
    struct Present {};
    using Keys = KeyTable<NodeKey, Present>;

    static NodeMask mask_in(const Keys& nodes, std::span<const NodeKey> keys) {
        NodeMask result = 0;
        if (nodes.size() == 0) return result;
        for (const NodeKey key : keys) nodes.prefetch(key);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (nodes.find(keys[i]) != nullptr) result |= NodeMask{1} << i;
        }
        return result;
    }

    Keys keys_;
    Keys unseen_;
    std::shared_ptr<const engine::CrossingNodes> crossing_;
};

}  // namespace nestgrid
