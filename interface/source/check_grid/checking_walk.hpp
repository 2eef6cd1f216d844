// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shows a hierarchy to the laws of check_grid, as grid_law.hpp says.
//
// Arrays that a grid or field fills have room for any rule: one that mistakes its rule for another
// is named, and writes nowhere else.
#pragma once

#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "grid_law.hpp"
#include "inspection.hpp"

namespace nestgrid::detail {

using GridLaws = std::vector<std::unique_ptr<GridLaw>>;

class CheckingWalk {
public:
    /// Both are borrowed.
    CheckingWalk(Inspection& inspection, const GridLaws& laws)
        : inspection_{&inspection},
          laws_{&laws},
          own_keys_{inspection.offers(Feature::own_keys)},
          components_{inspection.components()} {}

    /// \throw ViolationFound
    void run();

private:
    /// The split of an element on one level of the way down.
    struct Frame {
        Family children;
        std::vector<double> value;  // at the corners and new nodes
    };

    /// Calls a function of each law.
    template <class Function>
    void show(const Function& function) {
        for (const auto& law : *laws_) function(*law);
    }
    Frame& frame(int level);
    NodeKey place_of(const std::array<double, max_corners>& weights) const;
    CheckedElement coarse_element(std::size_t i);
    CheckedElement child(const CheckedElement& father, std::size_t number,
                         const std::vector<CheckedNode>& nodes);
    CheckedNode make_node(const Stencil& stencil, const std::vector<CheckedNode>& nodes) const;
    NodeMask values_that_count(std::span<double> values, NodeMask missing) const;

    void walk_coarse(std::size_t i);
    void walk(const CheckedElement& element);
    void walk_children(const CheckedElement& element, const Rule& rule);
    void put_corner_values(const CheckedElement& element, Frame& frame);
    std::vector<CheckedNode> nodes_of(const CheckedElement& element, const Rule& rule) const;
    void show_node(MadeNode made);
    void mark_seen(const CheckedElement& leaf);
    void walk_again(const CheckedElement& element);

    Inspection* inspection_;
    const GridLaws* laws_;
    bool own_keys_;
    std::size_t components_;
    Coarse coarse_;  // the one that the walk is in
    Family coarse_family_;
    std::deque<Frame> frames_;
};

}  // namespace nestgrid::detail
