// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The deviations of elements: how far the data at all nodes that are made in an element, at any
// depth, are from the interpolant of the values at its corners.
//
// One walk finds all of them: on the way down, each node has a row of numbers, the values there of
// the interpolants of the elements around it, one for each level. A new node takes the means of the
// rows of its parents, and each element the greatest difference to the value of the node.
// Time: O(depth) a node. Memory: O(depth^2).
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The deviation of an element, which the new nodes of its split take.
struct Deviation {
    std::span<const NodeKey> made;  ///< keys of the new nodes
    double deviation;  ///< |U - I U| is at most this in the element, where I U interpolates there
    double stop;       ///< |U - P_S U| is at most this where S holds at any of the new nodes
};

/// Computes deviations along a walk in depth-first order, which may begin below other elements.
template <class Real>
class PathDeviations {
public:
    using View = ElementView<Real>;

    /// \param walk must carry values and keys, and project nothing away
    explicit PathDeviations(const Walk<Real>& walk) : walk_{&walk} {}

    /// Called when the walk enters an element: leaves those that are not above it.
    /// \param value of the corners and, behind them, of the new nodes
    /// \param left left(Deviation) is called for each element that is left, with what is known of
    ///        it: the greatest numbers of all calls count
    template <class Left>
    void enter(const View& view, const Split& split, const Real* value, const Left& left) {
        const View* const above = split_above(view);
        while (depth_ > 0 && (above == nullptr || !levels_[depth_ - 1].is(*above))) leave(left);
        if (above != nullptr && depth_ == 0) push_all(*above);
        push(view, split, value);
    }
    /// Leaves all elements.
    template <class Left>
    void finish(const Left& left) {
        while (depth_ > 0) leave(left);
    }
    /// Forgets all elements.
    void clear() { depth_ = 0; }

private:
    /// An element above the walk, whose split makes nodes.
    struct Level {
        std::size_t coarse = 0;
        int level = 0;
        NodeKey path = 0;
        const Rule* rule = nullptr;
        std::size_t corners = 0;
        std::size_t stride = 0;      // of rows
        std::vector<double> rows;    // by node: its values of the interpolants, coarsest first
        std::vector<NodeKey> made;   // keys of the new nodes
        std::vector<double> offset;  // by new node: |U - P_S U| where it is dropped, at most
        double corner_offset = 0;    // the greatest one at the corners, of the father's new nodes
        double below = 0;            // greatest deviation of a child, with its corner_offset

        bool is(const View& view) const {
            return coarse == view.coarse && level == view.level && path == view.path;
        }
    };

    /// The next element above whose split makes nodes; null where there is none.
    static const View* split_above(const View& view);
    void push_all(const View& view);
    void push(const View& view, const Split& split, const Real* value);
    void take_corners(const View& view, const Real* value, Level& at);
    void take_new_nodes(const Real* value, Level& at);

    template <class Left>
    void leave(const Left& left) {
        const Level& at = levels_[--depth_];
        const double deviation = deviation_[depth_];
        left(Deviation{at.made, deviation, stop_of(at, deviation)});
        if (depth_ == 0) return;
        double& below = levels_[depth_ - 1].below;
        below = std::max(below, deviation + at.corner_offset);
    }
    static double stop_of(const Level& at, double deviation);

    const Walk<Real>* walk_;
    std::size_t depth_ = 0;
    std::vector<Level> levels_;      // the first depth_ ones
    std::vector<double> deviation_;  // of these
};

}  // namespace nestgrid::engine
