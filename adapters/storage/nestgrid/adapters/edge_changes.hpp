// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which edges have changed while a closure refines. A closure sweeps over the leaves until nothing
// changes: each sweep looks at leaves with edges that have changed since the one before began.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid::detail {

/// Names the edge between two nodes, in either order.
inline std::uint64_t edge_name(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t{a} << 32U | b : std::uint64_t{b} << 32U | a;
}

class EdgeChanges {
public:
    /// Changes before this are not noted.
    void begin() { has_begun_ = true; }
    bool has_begun() const { return has_begun_; }
    void set_node_count(std::size_t count) { touched_.resize(count, 0); }

    /// Notes for the next sweep that the edge between two nodes has changed.
    void note(std::uint32_t a, std::uint32_t b) {
        if (!has_begun_) return;
        noted_.insert(edge_name(a, b), {});
        touched_[a] = touched_[b] = sweep_ + 1;
    }
    /// \return false where nothing has changed since the last sweep began
    bool begin_sweep() {
        changed_ = std::exchange(noted_, {});
        if (changed_.size() == 0) return false;
        ++sweep_;
        return true;
    }
    /// Whether an edge of an element is one for this sweep to look at.
    bool any_of(Shape shape, std::span<const std::uint32_t> corner) const {
        const Topology& t = topology(shape);
        int touched = 0;
        for (std::size_t i = 0; i < t.corners; ++i) touched += is_touched(corner[i]) ? 1 : 0;
        if (touched < 2) return false;
        for (std::size_t i = 0; i < t.edges; ++i) {
            const std::uint32_t a = corner[t.edge[i][0]];
            const std::uint32_t b = corner[t.edge[i][1]];
            if (is_touched(a) && is_touched(b) && changed_.find(edge_name(a, b)) != nullptr) {
                return true;
            }
        }
        return false;
    }

private:
    struct Present {};

    bool is_touched(std::uint32_t node) const { return touched_[node] >= sweep_; }

    bool has_begun_ = false;
    KeyTable<std::uint64_t, Present> changed_;  // before this sweep
    KeyTable<std::uint64_t, Present> noted_;    // since it began
    std::vector<std::uint32_t> touched_;  // by node: the last sweep for which an edge has changed
    std::uint32_t sweep_ = 0;
};

}  // namespace nestgrid::detail
