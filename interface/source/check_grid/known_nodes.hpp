// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The nodes that elements have made so far, with the values that each got first.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/keys.hpp>

namespace nestgrid::detail {

/// A node as the first element told it that makes it.
struct KnownNode {
    NodeKey place = 0;
    NodeKey key = 0;
    std::size_t element = 0;   ///< that made it first, by its step (Inspection)
    std::size_t first = 0;     ///< of its values
    bool constrained = false;  ///< whether the grid says that it hangs
    bool hangs = false;        ///< or the check finds so
    bool seen = false;         ///< whether it is a corner of a leaf that is not hidden
};

class KnownNodes {
public:
    /// \param values of all components
    /// \return the node's number, and whether it is new; if not, nothing is changed
    std::pair<std::size_t, bool> insert(const KnownNode& node, std::span<const double> values) {
        const auto [number, is_new] = by_place_.insert(node.place, nodes_.size());
        if (!is_new) return {*number, false};
        const std::size_t fresh = *number;
        nodes_.push_back(node);
        nodes_.back().first = values_.size();
        values_.insert(values_.end(), values.begin(), values.end());
        by_key_.insert(node.key, fresh);
        return {fresh, true};
    }

    std::size_t size() const { return nodes_.size(); }
    KnownNode& operator[](std::size_t number) { return nodes_[number]; }
    const KnownNode& operator[](std::size_t number) const { return nodes_[number]; }
    /// \return the number of the node, or null
    const std::size_t* find(NodeKey place) const { return by_place_.find(place); }
    /// \return the number of the first node with this key, or null
    const std::size_t* find_key(NodeKey key) const { return by_key_.find(key); }
    /// All components of a node's value.
    std::span<const double> values(std::size_t number, std::size_t components) const {
        return std::span(values_).subspan(nodes_[number].first, components);
    }
    bool is_seen(NodeKey place) const {
        const std::size_t* number = find(place);
        return number != nullptr && nodes_[*number].seen;
    }

    /// The largest magnitude of a value that some element has told.
    double largest_value() const { return largest_value_; }
    void note_value(double value) { largest_value_ = std::max(largest_value_, std::abs(value)); }

private:
    KeyTable<NodeKey, std::size_t> by_place_;
    KeyTable<NodeKey, std::size_t> by_key_;
    std::vector<KnownNode> nodes_;
    std::vector<double> values_;
    double largest_value_ = 0;
};

}  // namespace nestgrid::detail
