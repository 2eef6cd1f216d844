// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes of a grid: one bit each where keys are dense, else a table.
#pragma once

#include <span>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

class NodeSet {
public:
    /// \param node_count number of dense keys; 0 where keys are not dense
    explicit NodeSet(std::size_t node_count = 0) : bits_(node_count) {}

    void insert(NodeKey key) {
        if (bits_.empty()) {
            table_.insert(key, {});
        } else if (const auto bit = bits_[static_cast<std::size_t>(key)]; !bit) {
            bits_[static_cast<std::size_t>(key)] = true;
            ++size_;
        }
    }
    bool contains(NodeKey key) const {
        return bits_.empty() ? table_.find(key) != nullptr : bits_[static_cast<std::size_t>(key)];
    }
    std::size_t size() const { return bits_.empty() ? table_.size() : size_; }
    bool empty() const { return size() == 0; }
    std::size_t memory_bytes() const { return table_.memory_bytes() + bits_.capacity() / 8; }

    /// Which of the keys it has, one bit each.
    NodeMask mask(std::span<const NodeKey> keys) const {
        NodeMask result = 0;
        if (empty()) return result;
        for (const NodeKey key : keys) table_.prefetch(key);
        for (std::size_t i = 0; i < keys.size(); ++i) result |= NodeMask{contains(keys[i])} << i;
        return result;
    }

    /// Those that are not in another set of the same grid.
    NodeSet without(const NodeSet& other) const {
        NodeSet result(bits_.size());
        for (std::size_t i = 0; i < bits_.size(); ++i) {
            if (bits_[i] && !other.bits_[i]) result.insert(static_cast<NodeKey>(i));
        }
        table_.for_each([&](NodeKey key, const Present&) {
            if (!other.contains(key)) result.insert(key);
        });
        return result;
    }

private:
    struct Present {};

    std::vector<bool> bits_;
    std::size_t size_ = 0;  // of the bits that are set
    KeyTable<NodeKey, Present> table_;
};

}  // namespace nestgrid
