// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of nodes, so that arrays can keep data of nodes while a grid is walked.
#pragma once

#include <span>
#include <string>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

[[noreturn]] NESTGRID_NOINLINE inline void refuse_key(NodeKey key, std::size_t node_count) {
    throw GridError("a node has the key " + std::to_string(static_cast<std::uint64_t>(key)) +
                    ", but node_count() is " + std::to_string(node_count) +
                    ": own keys must lie below it");
}

/// \throw GridError where a dense key is too large
inline void require_dense(NodeKey key, std::size_t node_count) {
    if (key >= node_count) refuse_key(key, node_count);
}

/// Numbers of nodes: the keys themselves where keys are dense, else 0, 1, ... in the order in which
/// find() meets the nodes.
class NodeNumbers {
public:
    /// \param dense how many dense keys there are, or 0
    explicit NodeNumbers(std::size_t dense) : dense_{dense} {}

    bool are_keys() const { return dense_ != 0; }
    /// A number above all numbers so far.
    std::size_t count() const { return are_keys() ? dense_ : sparse_.size(); }

    /// Sets out[i] to the number of the node with keys[i].
    /// \param out has a place for each key
    /// \throw GridError where a dense key is too large
    void find(std::span<const NodeKey> keys, std::span<std::size_t> out) {
        if (are_keys()) {
            for (std::size_t i = 0; i < keys.size(); ++i) {
                require_dense(keys[i], dense_);
                out[i] = static_cast<std::size_t>(keys[i]);
            }
            return;
        }
        for (const NodeKey key : keys) sparse_.prefetch(key);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            out[i] = *sparse_.insert(keys[i], sparse_.size()).first;
        }
    }

    /// Calls function(key, number) for all nodes that were met, where numbers are not keys.
    template <class Function>
    void for_each(Function&& function) const {
        sparse_.for_each(function);
    }

private:
    std::size_t dense_;
    KeyTable<NodeKey, std::size_t> sparse_;
};

}  // namespace nestgrid::engine
