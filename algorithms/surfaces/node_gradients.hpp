// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at nodes, for the normals of a surface (paper, section 8).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <contours/cell_contour.hpp>
#include <nestgrid/detail/inlining.hpp>
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

/// The gradient of a tetrahedron: that at its first corner.
inline CornerGradient tetrahedron_gradient(std::span<const Point, 4> x,
                                           std::span<const double, 4> value) {
    const DualVectors dual = dual_vectors({x[1] - x[0], x[2] - x[0], x[3] - x[0]}, 3);
    if (dual.volume == 0) return {};
    return {dual.gradient({value[1] - value[0], value[2] - value[0], value[3] - value[0]}),
            std::abs(dual.volume)};
}

/// The gradients at all corners. Where the map from the reference element is affine, all corners
/// have the same axes, and a simplex has the same gradient at all of them.
/// \param out as many as corners
inline void corner_gradients(const Topology& t, std::span<const Point> x,
                             std::span<const double> value, std::span<CornerGradient> out) {
    if (t.dimension == 3 && t.corners == 4) {
        std::ranges::fill(out, tetrahedron_gradient(x.first<4>(), value.first<4>()));
        return;
    }
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
/// Memory: 40 bytes a node, 8 of them without a gradient, in pieces of 1,024 nodes, and, in the
/// hash table, 4 bytes a slot, of which at most five eighths are used. Nothing is reserved beyond
/// that: surfaces have millions of nodes.
class NodeGradients {
public:
    using Index = std::uint32_t;

    /// The slot of a node, which is new where the node is.
    NESTGRID_INLINE Index slot(NodeKey node) {
        if (8 * (count_ + 1) > 5 * slots_.size()) grow();
        Index& at = place(node);
        if (at == none_) {
            if (count_ == keys_.size() * piece_) {
                keys_.push_back(std::make_unique<Keys>());
                sums_.emplace_back();
            }
            at = static_cast<Index>(count_++);
            key(at) = node;
            forget(at);
        }
        return at;
    }
    void add(Index slot, const CornerGradient& g) {
        std::unique_ptr<Sums>& piece = sums_[slot / piece_];
        if (piece == nullptr) piece = std::make_unique<Sums>();
        CornerGradient& sum = (*piece)[slot % piece_];
        sum.gradient = sum.gradient + g.weight * g.gradient;
        sum.weight += g.weight;
    }
    /// Makes a node one without gradients.
    void forget(Index slot) {
        if (sums_[slot / piece_] != nullptr) sum(slot) = {};
    }
    bool known(Index slot) const { return sums_[slot / piece_] != nullptr && sum(slot).weight > 0; }
    Point mean(Index slot) const { return (1 / sum(slot).weight) * sum(slot).gradient; }

    /// How many slots there are, and the node of each.
    std::size_t count() const { return count_; }
    NodeKey node(Index slot) const { return key(slot); }

    void clear() {
        std::ranges::fill(slots_, none_);
        count_ = 0;
    }

    std::size_t memory_bytes() const {
        const auto made = std::ranges::count_if(sums_, [](const auto& p) { return p != nullptr; });
        return slots_.capacity() * sizeof(Index) + keys_.size() * sizeof(Keys) +
               static_cast<std::size_t>(made) * sizeof(Sums);
    }

private:
    static constexpr Index none_ = std::numeric_limits<Index>::max();
    static constexpr std::size_t piece_ = 1024;

    using Keys = std::array<NodeKey, piece_>;
    using Sums = std::array<CornerGradient, piece_>;  // weighted sums, and the sums of weights

    NodeKey& key(Index slot) { return (*keys_[slot / piece_])[slot % piece_]; }
    const NodeKey& key(Index slot) const { return (*keys_[slot / piece_])[slot % piece_]; }
    CornerGradient& sum(Index slot) { return (*sums_[slot / piece_])[slot % piece_]; }
    const CornerGradient& sum(Index slot) const { return (*sums_[slot / piece_])[slot % piece_]; }

    NESTGRID_INLINE Index& place(NodeKey node) {
        const std::size_t mask = slots_.size() - 1;
        auto at = static_cast<std::size_t>(nestgrid::detail::mix(node)) & mask;
        while (slots_[at] != none_ && key(slots_[at]) != node) at = (at + 1) & mask;
        return slots_[at];
    }
    NESTGRID_NOINLINE void grow() {
        slots_.assign(std::max<std::size_t>(1024, 2 * slots_.size()), none_);
        for (Index i = 0; i < count_; ++i) place(key(i)) = i;
    }

    std::vector<Index> slots_;                 // a hash table: by key of the node
    std::vector<std::unique_ptr<Keys>> keys_;  // of nodes, by slot
    std::vector<std::unique_ptr<Sums>> sums_;  // by slot; null where no gradient was added
    std::size_t count_ = 0;                    // of nodes
};

}  // namespace nestgrid::engine
