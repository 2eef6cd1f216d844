// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <nestgrid/detail/key_table.hpp>

namespace nestgrid::detail {

/// One number for every node.
template <class Number>
struct NodeTable {
    std::vector<Number> dense;  ///< by key, where keys are dense; else empty
    KeyTable<NodeKey, Number> sparse;

    /// The number of a node; 0 where there is none.
    Number at(NodeKey node) const {
        if (!dense.empty()) return dense[static_cast<std::size_t>(node)];
        const Number* number = sparse.find(node);
        return number == nullptr ? Number{0} : *number;
    }
    /// Calls function(number) for all nodes.
    template <class Function>
    void for_each(Function&& function) const {
        for (const Number number : dense) function(number);
        sparse.for_each([&](NodeKey, Number number) { function(number); });
    }
    std::size_t memory_bytes() const {
        return dense.size() * sizeof(Number) + sparse.memory_bytes();
    }
};

}  // namespace nestgrid::detail
