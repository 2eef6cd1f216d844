// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes strictly inside closed edges (closed_parts.hpp): elements of a finer side record them, and
// elements of a coarser side take them for vertices.
//
// Invariants, after finish():
//   - the nodes of an edge are in the order of their places, each once, whoever recorded them;
//   - places count from the end of the edge that has the lesser key.
// Consequence: any number of elements, on any number of levels and sheets, finds the same nodes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

class SharedNodes;

/// A node inside an edge.
struct EdgeNode {
    KeyPair edge;
    double place;  ///< rises along the edge from its end with the lesser key
    NodeKey key;
    Point x;
    std::uint32_t values;  ///< number of its values in the record
};

class EdgeNodes {
public:
    /// Empties the record.
    /// \param components of the field, at each node
    void begin(std::size_t components);
    /// Adds a node; node.values may have any value.
    /// \param values P_S U at the node, a number for each component
    /// \throw GridError where there are 2^32 nodes or more
    void add(EdgeNode node, std::span<const double> values);
    /// Adds everything that a task recorded.
    void append(const EdgeNodes& task);
    /// Tells the ranks that may have the edges, and takes what they tell. Collective.
    void exchange(const SharedNodes& shared);
    /// Sorts the nodes, and drops those that were recorded twice.
    void finish();

    bool empty() const { return nodes_.empty(); }
    std::size_t size() const { return nodes_.size(); }
    /// The nodes strictly between two places on an edge, in their order. Requires finish().
    std::span<const EdgeNode> between(const KeyPair& edge,
                                      const std::array<double, 2>& places) const;
    std::span<const double> values(const EdgeNode& node) const {
        return std::span(values_).subspan(node.values * components_, components_);
    }
    std::size_t memory_bytes() const;

private:
    struct Range {
        std::uint32_t first;
        std::uint32_t count;
    };

    std::size_t components_ = 0;
    std::vector<EdgeNode> nodes_;
    std::vector<double> values_;
    KeyTable<KeyPair, Range> range_;  // by edge, after finish()
};

}  // namespace nestgrid::engine
