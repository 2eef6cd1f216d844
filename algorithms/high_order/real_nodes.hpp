// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll of a solution of higher degree: what holds at the nodes that the hierarchy itself
// makes, at any tolerance.
//
// A node inside an edge or face of a larger leaf hangs there: its value is that of the record, and
// beta is that of the part that it halves. Two numbers guide the search:
//   bound  |U - mean of P_S U at the parents|, and the greatest bound of finer nodes: on an element
//   U
//          is within P_S U at the corners +- the greatest bound of its new nodes. At a node that
//          hangs, P_S U may be that mean; what this moves is added where the node is a parent or a
//          corner (deviation);
//   stop   with the tolerance tau, S = (stop <= tau) holds only where every element that may stop
//          differs from U by at most tau, and where all edges and faces of leaves around and below
//          are flat at tau / 3. It is saturated: at a corner no less than at the new nodes. A
//          triangle has no node of its own. The edges that halve it are edges of children, and its
//          parts are faces of leaves: where these are flat, every deeper node in it hangs.
// Consequence: where an element stops, every deeper node on its faces is interpolated, those of the
// hierarchy by `stop`, virtual ones by beta.
#pragma once

#include <high_order/leaf_records.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid::engine {

/// Parts are flat where beta is at most tau / 3: in all dimensions, so that parts of what is flat
/// are flat.
inline constexpr double flat_share = 3;

struct RealNode {
    double beta = 0;  ///< of the part that the node halves, where it hangs
    float stop = 0;   ///< rounded up, as the others
    float bound = 0;
    float off = 0;  ///< the node's own part of the bound
    bool hangs = false;
    std::uint8_t shift = 0;    ///< the part halved has 2^-shift of the size of the record
    std::uint32_t halves = 0;  ///< where it hangs, the number of the part that it halves, if any
    /// For a lens: the greatest diameter of the elements that make the node, and 5/4 of the size of
    /// finer nodes. T at a node is at least that at a corner less slope times this diameter.
    float size = 0;
};

/// The table of all nodes of the hierarchy, which is also the guide of searches.
class RealNodes final : public Bounds {
public:
    /// \param epoch of the hierarchy
    /// \param summary of the leaves, which is set
    /// \param executor for what leaves are asked for
    /// \throw GridError as LeafRecords
    RealNodes(std::uint64_t epoch, const LeafFunction& function, const BaseWalk& walk,
              LeafSummary& summary, const Executor& executor);

    const RealNode* find(NodeKey key) const {
        const std::uint32_t* const at = number_.find(key);
        return at == nullptr ? nullptr : &nodes_[*at];
    }
    /// Values of all components at a node, which exists.
    const double* values(NodeKey key) const {
        return values_.data() + *number_.find(key) * components_;
    }
    std::size_t size() const { return nodes_.size(); }
    /// The part of a leaf that a node halves.
    PartOfLeaf part_halved(const RealNode& node) const;
    std::size_t memory_bytes() const;

    double offset_bound(NodeKey node) const override;
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override;
    const HangingNodes* hanging() const override { return nullptr; }
    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }
    double least() const override { return least_; }
    double greatest() const override { return greatest_; }

private:
    struct Split {
        std::array<std::uint32_t, max_split_nodes> node;  // corners first
        const Rule* rule;
        int level;
    };
    struct HalvedPart {
        std::uint32_t leaf = 0;
        std::uint8_t level = 0;
        std::uint8_t count = 0;
        std::array<std::array<std::int32_t, 3>, 4> corner{};

        HalvedPart() = default;
        explicit HalvedPart(const PartOfLeaf& part);
    };
    using LeafNodes = std::array<std::uint32_t, max_corners>;  // at the corners of a leaf
    class Preroll;

    std::uint64_t epoch_;
    std::size_t components_;
    double least_ = 0;  // of component 0
    double greatest_ = 0;
    std::vector<RealNode> nodes_;
    std::vector<HalvedPart> parts_{1};  // that nodes halve; the first one is none
    std::vector<double> values_;
    KeyTable<NodeKey, std::uint32_t> number_;
};

}  // namespace nestgrid::engine
