// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Functions that begin at elements and are interpolated below them, on the way of a walk.
//
// Each node of the elements that the walk is in has a row of numbers: its values of all functions
// that have begun, one column a function, those of the coarsest element first. The corners of an
// element take their rows from the element above, and new nodes take the means of the rows of their
// parents. An element may begin functions of its own in further columns.
// Time: O(columns) a node. Memory: O(columns) for each node of the elements that the walk is in.
#pragma once

#include <array>
#include <deque>
#include <span>
#include <vector>

#include <walk/walk.hpp>

namespace nestgrid::engine {

/// The rows of the elements that a walk in depth-first order is in. The walk may begin below other
/// elements.
template <class Real>
class PathRows {
public:
    using View = ElementView<Real>;

    /// An element that the walk is in.
    struct Element {
        std::size_t coarse = 0;
        int level = 0;
        NodeKey path = 0;
        std::size_t corners = 0;
        std::size_t columns = 0;
        std::size_t stride = 0;    ///< of rows: `columns` or a few more
        std::vector<double> rows;  ///< by node, corners first
        const Rule* rule = nullptr;
        std::vector<NodeKey> made;  ///< keys of the new nodes
        /// Which nodes of the element above the corners are.
        std::array<std::uint8_t, max_corners> node{};

        double* row(std::size_t n) { return rows.data() + n * stride; }
        const double* row(std::size_t n) const { return rows.data() + n * stride; }
        bool is(const View& view) const {
            return coarse == view.coarse && level == view.level && path == view.path;
        }
    };

    /// The next element above whose split makes nodes; null where there is none.
    static const View* split_above(const View& view);
    /// The split of an element that the walk is below.
    /// \param keys takes the keys of the new nodes
    static Split split_of(const View& view, SplitKeys& keys);

    std::size_t depth() const { return depth_; }
    /// The element that was entered last. Requires depth() > 0.
    Element& last() { return elements_[depth_ - 1]; }
    /// The element above that one. Requires depth() > 1.
    Element& above_last() { return elements_[depth_ - 2]; }

    /// Enters an element below the last one, of which it is a child but for copies between them, or
    /// a first one. The columns that the element begins are left to the caller to fill.
    /// \param begun how many columns the element begins
    Element& enter(const View& view, std::size_t begun);
    /// Makes the rows of the new nodes of the last element.
    void split(const Rule& rule, std::span<const NodeKey> made);
    void leave() { --depth_; }
    /// Leaves all elements.
    void clear() { depth_ = 0; }

private:
    std::size_t depth_ = 0;
    std::deque<Element> elements_;  // the first depth_ ones
};

}  // namespace nestgrid::engine
