// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The deviations of elements: how far the data at all nodes that are made in an element, at any
// depth, are from the interpolant of the values at its corners.
//
// One walk finds all of them: on the way down, each node has a row (path_rows.hpp) of the values
// there of the interpolants of the elements around it, one for each level, and each element takes
// the greatest difference to the value of the node.
// Time: O(depth) a node. Memory: O(depth^2).
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include <indicators/path_rows.hpp>

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
        const View* const above = PathRows<Real>::split_above(view);
        while (rows_.depth() > 0 && (above == nullptr || !rows_.last().is(*above))) leave(left);
        if (above != nullptr && rows_.depth() == 0) push_all(*above);
        push(view, split, value);
    }
    /// Leaves all elements.
    template <class Left>
    void finish(const Left& left) {
        while (rows_.depth() > 0) leave(left);
    }
    /// Forgets all elements.
    void clear() { rows_.clear(); }

private:
    /// What is known of an element that the walk is in, beside its rows.
    struct Offsets {
        std::vector<double> of_new;  // by new node: |U - P_S U| where it is dropped, at most
        double of_corners = 0;       // the greatest one at the corners, of the father's new nodes
        double below = 0;            // greatest deviation of a child, with its of_corners
    };

    void push_all(const View& view);
    void push(const View& view, const Split& split, const Real* value);
    void compare_new_nodes(const Rule& rule, const Real* value);
    double corner_offset();

    template <class Left>
    void leave(const Left& left) {
        const std::size_t at = rows_.depth() - 1;
        const double deviation = deviation_[at];
        left(Deviation{rows_.last().made, deviation, stop_of_last()});
        if (at > 0) {
            double& below = offsets_[at - 1].below;
            below = std::max(below, deviation + offsets_[at].of_corners);
        }
        rows_.leave();
    }
    double stop_of_last();

    const Walk<Real>* walk_;
    PathRows<Real> rows_;            // column a: the interpolant of element a
    std::vector<Offsets> offsets_;   // by element
    std::vector<double> deviation_;  // by element, padded like the rows
};

}  // namespace nestgrid::engine
