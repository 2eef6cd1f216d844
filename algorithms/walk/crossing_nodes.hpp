// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Crossing nodes, on grids that give the parents of hanging nodes (hanging_parents, optional.hpp):
// the elements on the two sides of a face divide it in different directions, and a node lies where
// the divisions cross, so that two elements make it by different stencils. Either the node hangs on
// an edge of a leaf, and the ends of that edge are no nodes of an element that makes the node; or
// it hangs nowhere, and has the value that the field gives.
//
// Fixed nodes are
//   - the crossing nodes;
//   - the parents of each fixed node that hangs;
//   - the corners of a child's quadrilateral in a face of its father, where one of them is a
//     crossing node that the father makes by a stencil that is not the node's own, and the next one
//     is a parent of that node, or hangs between that node and another one.
// Invariants:
//   - S holds at no fixed node, because the walk calls all of them `outside`. So no element that
//     makes one stops, nor does one above it, and the value of a fixed node depends on no
//     criterion: each walk computes it before it begins (crossed_parts.hpp);
//   - where a fixed node hangs, it has the mean of its parents here, wherever it is made.
// Consequence: a fixed node on an edge or face of an element that stops hangs on an edge or face of
// a leaf below that element, and has the value that the element has there.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <nestgrid/detail/hanging_probe.hpp>
#include <nestgrid/hierarchy.hpp>
#include <walk/walk.hpp>

namespace nestgrid::engine {

/// A node whose value is computed before the walk.
struct FixedNode {
    NodeKey key = 0;
    Point position{};
    bool crosses = false;
    bool hangs = false;
    // Set if the node hangs: its stencil over fixed nodes with lower numbers.
    Stencil stencil{};
    std::array<std::uint32_t, max_corners> parent{};
    NodeKey parents = 0;  ///< a hash of their keys
    // Set otherwise: an element that creates the node, or a coarse element with this corner.
    const Rule* rule = nullptr;  ///< null on the coarse grid
    std::size_t element = 0;     ///< in elements(), or the number of the coarse element
    std::uint8_t node = 0;       ///< new node of the rule, or corner
};

/// All fixed nodes of a grid.
class CrossingNodes {
public:
    const std::vector<FixedNode>& nodes() const { return nodes_; }
    const Elements& elements() const { return elements_; }
    /// The number of a fixed node, or null.
    const std::uint32_t* find(NodeKey key) const { return number_.find(key); }
    std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(FixedNode) + elements_.memory_bytes() +
               number_.memory_bytes();
    }
    /// Mask of the new nodes at which this element's stencil must not be used: another stencil is
    /// the node's, or the node does not hang.
    /// \param keys of the corners, then of the new nodes
    NodeMask made_by_other_stencils(const Rule& rule, std::span<const NodeKey> keys) const;
    /// Replaces an edge by the one in whose middle one of its ends hangs.
    /// \return whether there is one
    bool extend(std::array<NodeKey, 2>& edge) const;

private:
    template <class Real>
    friend class CrossingSearch;

    std::vector<FixedNode> nodes_;
    Elements elements_;
    KeyTable<NodeKey, std::uint32_t> number_;
};

/// Finds the crossing nodes of a grid that gives parents, while its hanging nodes are derived.
template <class Real>
class CrossingSearch {
public:
    /// \param walk with keys
    explicit CrossingSearch(const Walk<Real>& walk) : walk_{&walk} {}

    /// Takes a split, and hands the parents that the grid gives to the probe.
    /// \param keys of the corners, then of the new nodes
    void add_split(const Rule& rule, std::span<const NodeKey> keys, detail::HangingProbe& probe);
    /// \param probe that has probed all leaves
    /// \return null where no node crosses
    /// \throw GridError where a node hangs on two edges that give it different values, or has
    ///        several stencils and hangs without parents that the grid gives
    std::shared_ptr<const CrossingNodes> find(const detail::HangingProbe& probe,
                                              const HangingNodes& hanging);

private:
    /// How the first element that makes a node does so.
    struct Made {
        const Stencil* stencil = nullptr;
        std::array<NodeKey, max_corners> parent{};
        NodeKey parents = 0;              ///< a hash of their keys
        bool has_other_stencils = false;  ///< those of other elements
    };
    /// Stands for the number of a node that need() has begun.
    static constexpr std::uint32_t pending = ~std::uint32_t{0};

    bool crosses(NodeKey node, const Made& made) const;
    std::uint32_t need(NodeKey key);
    bool hangs_beside(NodeKey node, NodeKey end) const;
    void need_around();
    void need_around(const Child& child, NodeMask crossing, std::size_t corners,
                     std::span<const NodeKey> keys);
    void locate();
    void locate_makers(const ElementView<Real>& view, const Split& split);
    [[noreturn]] void refuse(NodeKey node, const std::string& what) const;

    const Walk<Real>* walk_;
    KeyTable<NodeKey, Made> made_;
    // Set while find() runs.
    const detail::HangingProbe* probe_ = nullptr;
    const HangingNodes* hanging_ = nullptr;
    std::shared_ptr<CrossingNodes> found_;
};

}  // namespace nestgrid::engine
