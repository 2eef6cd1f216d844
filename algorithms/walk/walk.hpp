// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The depth-first traversal (paper, section 3) with the adaptive projection of eq. (2).
//
// Invariants:
//   - a new node's value is the interpolant where S holds or the node hangs, else U itself, or,
//     where S is a weight between 0 and 1, S times the interpolant and 1 - S times U; and its
//     position likewise, where the grid gives one;
//   - nodes of hidden leaves alone count as hanging ones;
//   - U is asked for only where it is used, the children only when they are entered;
//   - what the walk knows of an element lies in the frame of its father's split, one frame a level.
// Consequences: memory is O(depth), allocated when a level is first reached and never in the loop;
// two elements that share a node see the same bits there, because every mean is a symmetric
// function of its arguments (mean.hpp).
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <nestgrid/detail/hanging.hpp>
#include <walk/crossed_parts.hpp>
#include <walk/position_functions.hpp>
#include <walk/visitor.hpp>

namespace nestgrid::engine {

/// Room for the keys of the corners and new nodes of any split.
using SplitKeys = std::array<NodeKey, max_corners + max_new_nodes>;

/// Room for the positions of the same nodes.
using SplitPositions = std::array<Point, max_corners + max_new_nodes>;

/// What a walk carries along.
struct Needs {
    bool values = true;      ///< otherwise all values are undefined and the field is never asked
    bool keys = true;        ///< keys of new nodes, and of corners by Walk::corners()
    bool positions = false;  ///< positions by Walk::corners()
    bool closed = false;     ///< closed edges and faces; needs the other three
    bool placed = false;     ///< true positions by Walk::placed_corners(); needs `positions`
    bool on_ranks = false;   ///< the caller is made for the part of a grid that one rank has
};

/// The nodes of one split, and the children.
template <class Real>
struct Frame {
    std::vector<Real> value;        ///< of the corners, then of the new nodes
    std::vector<NodeKey> key;       ///< of the same nodes
    std::vector<Point> position;    ///< of the same nodes, as S places them
    std::vector<Point> placed;      ///< of the same nodes, where the grid has them
    std::vector<Real> child_value;  ///< at the corners of the child that the walk is at
    Family family;
    std::unique_ptr<ClosingSplit<Real>> closing;
    std::unique_ptr<CrossedSplit<Real>> crossed;
};

/// The memory of one walk: a frame a level, and the grid's own state.
template <class Real>
class WalkStack {
public:
    /// Frame of the split of an element on a level.
    Frame<Real>& frame(int level) {
        const auto at = static_cast<std::size_t>(level);
        while (frames_.size() <= at) [[unlikely]] {
                frames_.push_back(std::make_unique<Frame<Real>>());
            }
        return *frames_[at];
    }
    std::unique_ptr<Task> task;
    // The coarse element that the walk is below.
    Coarse coarse;
    Family family;
    std::vector<Real> value;
    std::array<NodeKey, max_corners> key{};

private:
    std::vector<std::unique_ptr<Frame<Real>>> frames_;
};

/// Walks a hierarchy. Construction looks at the coarse grid once. Several threads may walk.
template <class Real>
class Walk {
public:
    using View = ElementView<Real>;

    /// \param hanging nodes that hang, where the grid does not say so itself; may be null
    /// \param functions that the walk sets the first components to, where the hierarchy leaves
    ///        them undefined (WidenedHierarchy); or null. The walk must carry values and positions.
    ///
    /// \throw GridError where a coarse element has a shape of another dimension than the grid, and
    ///        as require_whole_grid() unless needs.on_ranks says otherwise
    Walk(const Hierarchy<Real>& hierarchy, const Needs& needs,
         const HangingNodes* hanging = nullptr, const PositionFunctions* functions = nullptr);

    const Hierarchy<Real>& hierarchy() const { return *hierarchy_; }
    std::size_t components() const { return components_; }
    /// The functions of position that are the first components, or null.
    const PositionFunctions* functions() const { return functions_; }
    /// The number of these components.
    std::size_t function_count() const { return functions_ == nullptr ? 0 : functions_->count(); }

    void run(Visitor<Real>& visitor) const { run(visitor, 0, hierarchy_->coarse_count()); }
    /// Visits the coarse elements first ... last - 1 and all below them, in order.
    void run(Visitor<Real>& visitor, std::size_t first, std::size_t last) const;
    /// Visits an element and all below it.
    void walk_below(const View& view, Visitor<Real>& visitor) const;
    // The same, compiled for one class of visitors, which is to be final (walk_steps.hpp).
    template <class V>
    void run_as(V& visitor, std::size_t first, std::size_t last) const;
    template <class V>
    void run_as(V& visitor) const {
        run_as(visitor, 0, hierarchy_->coarse_count());
    }
    template <class V>
    void walk_below_as(const View& view, V& visitor) const;

    /// Keys and positions of the corners; each pointer may be null.
    void corners(const View& view, NodeKey* keys, Point* positions) const;
    /// Positions of the corners where the grid has them, also of those that hang or at which S
    /// holds, where the walk carries these.
    void placed_corners(const View& view, Point* out) const;
    /// Whether placed_corners() and the positions of corners() may differ.
    bool places_corners() const { return carries_placed_; }
    /// Keys of the corners of a split element and, behind them, of its new nodes.
    /// \param out takes them
    std::span<const NodeKey> split_keys(const View& view, const Split& split, SplitKeys& out) const;
    /// Positions of the ends of a maximal edge.
    std::array<Point, 2> positions(const MaximalEdge<Real>& edge) const;
    /// Positions of the corners of a split element and, behind them, of its new nodes: the true
    /// ones, but where nodes hang. The walk must carry positions.
    /// \param out takes them
    std::span<const Point> split_positions(const View& view, const Split& split,
                                           SplitPositions& out) const;
    /// The corners that hidden leaves alone have, one bit each.
    NodeMask unseen_corners(const View& view) const;
    /// Faces on the boundary of the domain, one bit each.
    unsigned boundary(const View& view) const;
    /// Gradients of component 0 at the corners, where the field offers them.
    void gradients(const View& view, std::span<Point> out) const;

private:
    using Stack = WalkStack<Real>;

    bool make_coarse(std::size_t i, Stack& stack, View& view) const;
    void put_coarse_values(View& view) const;
    template <class V>
    void visit(const View& view, V& visitor) const;
    template <class V>
    void descend(const View& view, const Split& split, const Decision& decision, V& visitor) const;
    void project(const View& view, const Split& split, NodeMask mean, NodeMask wanted,
                 Frame<Real>& frame) const;
    void put_far_values(const View& view, const Split& split, NodeMask missing, Real* out) const;
    NodeMask blend(const Split& split, NodeMask mean, std::span<const float> weights,
                   Frame<Real>& frame) const;
    void project_positions(const View& view, const Split& split, NodeMask mean,
                           Frame<Real>& frame) const;
    void put_functions(const View& view, const Split& split, NodeMask mean,
                       Frame<Real>& frame) const;
    const ClosingSplit<Real>* close(const View& view, const Split& split, NodeMask mean,
                                    Frame<Real>& frame) const;
    void mark_crossing(const View& view, Split& split) const;
    template <class V>
    void visit_children(const View& view, const Split& split, NodeMask interpolated,
                        const ClosingSplit<Real>* closing, Frame<Real>& frame, V& visitor) const;
    View make_child(const View& father, const Rule& rule, const Frame<Real>& frame) const;
    void set_child(const View& father, const Child& as, std::size_t c, Frame<Real>& frame,
                   View& child) const;
    void copy_components(const Child& as, const Real* from, Real* to) const;
    static std::uint8_t boundary_of_child(const View& father, const Child& as);
    static std::uint8_t interpolated_corners(const View& father, const Child& as,
                                             NodeMask interpolated);

    std::unique_ptr<Stack> take_stack() const;
    void give_back(std::unique_ptr<Stack> stack) const;

    const Hierarchy<Real>* hierarchy_;
    const HangingNodes* hanging_;
    Needs needs_;
    std::size_t components_;
    const PositionFunctions* functions_;
    std::vector<std::uint8_t> boundary_;  // of each coarse element, where the grid does not say
    bool boundary_faces_;
    bool own_keys_;
    bool own_positions_;
    bool new_positions_;
    bool constrained_;
    bool carries_keys_;
    bool carries_positions_;
    bool carries_placed_;
    std::unique_ptr<const FixedNodes<Real>> fixed_;  // null where no node crosses
    mutable std::mutex mutex_;
    mutable std::vector<std::unique_ptr<Stack>> idle_;  // whose memory is free to be used
};

}  // namespace nestgrid::engine
