// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The values of a field at nodes of which this rank has no leaf, or is asked at an element whose
// leaf with the node is elsewhere: those of the least rank that has one.
#pragma once

#include <bit>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

class FarValues {
public:
    explicit FarValues(std::size_t components) : components_{components} {}

    void add(NodeKey node, std::span<const double> values) {
        if (!first_.insert(node, values_.size()).second) return;
        values_.insert(values_.end(), values.begin(), values.end());
    }

    /// Gives values where a field has none.
    /// \param out the last components at each node are those of the field
    /// \param stride the number of components at a node
    /// \return the nodes that are still without a value
    template <class Real>
    NodeMask give(std::span<const NodeKey> nodes, NodeMask missing, Real* out,
                  std::size_t stride) const {
        NodeMask left = missing;
        for (NodeMask todo = missing; todo != 0; todo &= todo - 1) {
            const auto n = static_cast<std::size_t>(std::countr_zero(todo));
            const std::size_t* const first = n < nodes.size() ? first_.find(nodes[n]) : nullptr;
            if (first == nullptr) continue;
            for (std::size_t c = 0; c < components_; ++c) {
                out[(n + 1) * stride - components_ + c] = static_cast<Real>(values_[*first + c]);
            }
            left &= ~(NodeMask{1} << n);
        }
        return left;
    }

private:
    std::size_t components_;
    std::vector<double> values_;
    KeyTable<NodeKey, std::size_t> first_;
};

}  // namespace nestgrid::engine
