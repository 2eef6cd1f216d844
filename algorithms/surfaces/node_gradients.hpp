// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at nodes, for the normals of a surface (paper, section 8).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include <contours/cell_contour.hpp>
#include <nestgrid/keys.hpp>
#include <nestgrid/shape.hpp>
#include <walk/gradient.hpp>

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
    const DualVectors dual = dual_vectors(along, t.dimension);
    if (dual.volume == 0) return {};
    return {dual.gradient(rise), std::abs(dual.volume)};
}

/// The gradients at all corners. Where the map from the reference element is affine, all corners
/// have the same axes, and a simplex has the same gradient at all of them.
/// \param out as many as corners
inline void corner_gradients(const Topology& t, std::span<const Point> x,
                             std::span<const double> value, std::span<CornerGradient> out) {
    if (t.corners == t.dimension + 1U) {
        std::ranges::fill(out, corner_gradient(t, x, value, 0));
        return;
    }
    if (t.dimension == 3 && t.corners == 8 && is_parallelepiped(x.first<8>())) {
        const DualVectors dual = dual_vectors({x[1] - x[0], x[2] - x[0], x[4] - x[0]}, 3);
        for (std::size_t i = 0; i < 8; ++i) {
            const auto rise = [&](std::size_t axis) { return value[i | axis] - value[i & ~axis]; };
            out[i] = {dual.gradient({rise(1), rise(2), rise(4)}), std::abs(dual.volume)};
        }
        return;
    }
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = corner_gradient(t, x, value, i);
}

/// Gradients at nodes: the weighted mean of the gradients that are added at each.
///
/// Memory: 40 bytes a node and, in the hash table, 4 bytes a slot, of which at most five eighths
/// are used. Nothing is reserved beyond that: surfaces have millions of nodes.
class NodeGradients {
public:
    using Index = std::uint32_t;

    /// The slot of a node, which is new where the node is.
    Index slot(NodeKey node) {
        if (8 * (keys_.size() + 1) > 5 * slots_.size()) grow();
        Index& at = place(node);
        if (at == none_) {
            at = static_cast<Index>(keys_.size());
            keys_.push_back(node);
            sums_.push_back({});
        }
        return at;
    }
    void add(Index slot, const CornerGradient& g) {
        CornerGradient& sum = sums_[slot];
        sum.gradient = sum.gradient + g.weight * g.gradient;
        sum.weight += g.weight;
    }
    /// Makes a node one without gradients.
    void forget(Index slot) { sums_[slot] = {}; }
    bool known(Index slot) const { return sums_[slot].weight > 0; }
    Point mean(Index slot) const { return (1 / sums_[slot].weight) * sums_[slot].gradient; }

    /// The keys of the nodes, by slot.
    const std::deque<NodeKey>& nodes() const { return keys_; }

    void clear() {
        std::ranges::fill(slots_, none_);
        keys_.clear();
        sums_.clear();
    }

    std::size_t memory_bytes() const {
        return slots_.capacity() * sizeof(Index) +
               keys_.size() * (sizeof(NodeKey) + sizeof(CornerGradient));
    }

private:
    static constexpr Index none_ = std::numeric_limits<Index>::max();

    Index& place(NodeKey node) {
        const std::size_t mask = slots_.size() - 1;
        auto at = static_cast<std::size_t>(nestgrid::detail::mix(node)) & mask;
        while (slots_[at] != none_ && keys_[slots_[at]] != node) at = (at + 1) & mask;
        return slots_[at];
    }
    void grow() {
        slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), none_);
        for (Index i = 0; i < keys_.size(); ++i) place(keys_[i]) = i;
    }

    std::vector<Index> slots_;         // a hash table: by key of the node
    std::deque<NodeKey> keys_;         // by slot
    std::deque<CornerGradient> sums_;  // weighted sums, and sums of weights, by slot
};

}  // namespace nestgrid::engine
