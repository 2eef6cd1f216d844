// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at nodes, for the normals of a surface (paper, section 8).
#pragma once

#include <vector>

#include <nestgrid/key_table.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid::engine {

/// The gradient of an element's function at a corner, from the differences along the edges that
/// meet there, and six times the volume they span (twice the area in two dimensions).
struct CornerGradient {
    Point gradient{0, 0, 0};
    double weight = 0;
};

inline CornerGradient corner_gradient(const Topology& t, std::span<const Point> x,
                                      std::span<const double> value, std::size_t corner) {
    std::array<Point, 3> along{};
    std::array<double, 3> rise{};
    std::size_t count = 0;
    for (std::size_t e = 0; e < t.edges && count < t.dimension; ++e) {
        for (std::size_t end = 0; end < 2; ++end) {
            if (t.edge[e][end] != corner) continue;
            const std::size_t other = t.edge[e][1 - end];
            along[count] = x[other] - x[corner];
            rise[count++] = value[other] - value[corner];
        }
    }
    if (t.dimension == 2) {  // in the plane of the element, which may lie in space
        along[2] = cross(along[0], along[1]);
        const double area = norm(along[2]);
        if (area > 0) along[2] = (1 / area) * along[2];
    }
    const std::array<Point, 3> dual{cross(along[1], along[2]), cross(along[2], along[0]),
                                    cross(along[0], along[1])};
    const double volume = dot(along[0], dual[0]);
    if (volume == 0) return {};
    Point g{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) g = g + (rise[i] / volume) * dual[i];
    return {g, std::abs(volume)};
}

/// Gradients at nodes: the weighted mean of the gradients that are added at each.
class NodeGradients {
public:
    using Index = std::uint32_t;

    Index slot(NodeKey node) {
        const auto [at, is_new] = slot_of_.insert(node, static_cast<Index>(entries_.size()));
        const Index number = *at;
        if (is_new) entries_.push_back({});
        return number;
    }
    void add(Index slot, const CornerGradient& g) {
        entries_[slot].gradient = entries_[slot].gradient + g.weight * g.gradient;
        entries_[slot].weight += g.weight;
    }
    bool known(Index slot) const { return entries_[slot].weight > 0; }
    Point mean(Index slot) const { return (1 / entries_[slot].weight) * entries_[slot].gradient; }

    /// The keys of the nodes, by slot.
    std::vector<NodeKey> nodes() const {
        std::vector<NodeKey> keys(entries_.size());
        slot_of_.for_each([&](NodeKey node, Index slot) { keys[slot] = node; });
        return keys;
    }

    void clear() {
        slot_of_.clear();
        entries_.clear();
    }

    std::size_t memory_bytes() const {
        return slot_of_.memory_bytes() + entries_.capacity() * sizeof(CornerGradient);
    }

private:
    KeyTable<NodeKey, Index> slot_of_;
    std::vector<CornerGradient> entries_;  // weighted sums, and sums of weights
};

}  // namespace nestgrid::engine
