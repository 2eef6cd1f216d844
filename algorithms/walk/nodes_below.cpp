// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <walk/nodes_below.hpp>

#include <algorithm>
#include <cmath>

namespace nestgrid::engine {

template <class Real>
NodeSet find_missing_nodes(const Hierarchy<Real>& hierarchy) {
    NodeSet missing(hierarchy.facts().node_count);
    std::vector<Real> values;
    hierarchy.star_rows([&](const StarRow& row) {
        if (row.gathers) return;
        values.resize(row.count);
        hierarchy.row_values(static_cast<NodeKey>(row.first), row.stride, values);
        for (std::size_t i = 0; i < row.count; ++i) {
            if (std::isnan(values[i])) {
                missing.insert(static_cast<NodeKey>(row.first + i * row.stride));
            }
        }
    });
    return missing;
}

template <class Real>
NodesBelow::NodesBelow(const Hierarchy<Real>& hierarchy, NodeSet nodes)
    : nodes_{std::move(nodes)}, flags_(hierarchy.facts().node_count) {
    hierarchy.star_rows([&](const StarRow& row) { row.gathers ? gather(row) : raise(row); });
    gathered_ = {};
}

/// The flags of finer nodes around one.
std::uint8_t NodesBelow::around(std::size_t node, std::span<const std::ptrdiff_t> finer) const {
    std::uint8_t all = 0;
    for (const std::ptrdiff_t to : finer) all |= flags_[node + static_cast<std::size_t>(to)];
    return all;
}

void NodesBelow::raise(const StarRow& row) {
    for (std::size_t i = 0; i < row.count; ++i) {
        const std::size_t node = row.first + i * row.stride;
        const bool own = nodes_.contains(static_cast<NodeKey>(node));
        std::uint8_t flags = around(node, row.finer) | (own ? some_ : others_);
        for (const std::ptrdiff_t to : row.finer) {
            if (gathered_.empty()) break;
            flags |= gathered_[node + static_cast<std::size_t>(to)];
        }
        flags_[node] = flags;
    }
}

void NodesBelow::gather(const StarRow& row) {
    gathered_.resize(flags_.size());
    for (std::size_t i = 0; i < row.count; ++i) {
        const std::size_t node = row.first + i * row.stride;
        gathered_[node] = around(node, row.finer);
    }
}

template NodeSet find_missing_nodes(const Hierarchy<float>&);
template NodeSet find_missing_nodes(const Hierarchy<double>&);
template NodesBelow::NodesBelow(const Hierarchy<float>&, NodeSet);
template NodesBelow::NodesBelow(const Hierarchy<double>&, NodeSet);

}  // namespace nestgrid::engine
