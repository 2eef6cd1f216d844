// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Level by level, for prerolls: "a depth first traversal of the hierarchy in the adjustment
// procedure would not be sufficient" (paper, section 2). A level is visited by descending to it
// from the coarse grid, so a sweep over all levels costs a small multiple of one traversal and no
// memory. Here a level is the depth in the tree.
#pragma once

#include <nestgrid/traversal.hpp>

namespace nestgrid {

namespace detail {

template <class Function>
struct LevelVisitor {
    int level;
    Function& function;

    bool sees_hidden() const { return true; }

    template <class State>
    Decision inspect(const State& s, const Split& split) {
        if (s.level < level) return {};
        if (s.level == level) function(s, split);
        return {Visit::skip, 0};
    }
    template <class State>
    void extract(const State&) {}
};

template <bool splits_only, class Function>
struct EachVisitor {
    Function& function;

    bool passes_over_leaves() const { return splits_only; }
    bool sees_hidden() const { return true; }

    template <class State>
    Decision inspect(const State& s, const Split& split) {
        function(s, split);
        return {};
    }
    template <class State>
    void extract(const State&) {}
};

}  // namespace detail

/// Calls function(state, split) for every element on a level, leaves (split.rule is null there) and
/// hidden ones included, with the true values at the corners, hanging nodes interpolated.
template <class Walk, class Function>
void for_each_on_level(const Walk& walk, int level, Function&& function) {
    detail::LevelVisitor<Function> visitor{level, function};
    walk.run(visitor);
}

/// The same for all elements, depth first.
/// \tparam splits_only pass over leaves, those of the coarse grid excepted
template <bool splits_only = false, class Walk, class Function>
void for_each_element(const Walk& walk, Function&& function) {
    detail::EachVisitor<splits_only, Function> visitor{function};
    walk.run(visitor);
}

/// Number of levels of a hierarchy: 1 for a coarse grid alone.
template <class Walk>
int count_levels(const Walk& walk) {
    int levels = 0;
    for_each_element(walk,
                     [&](const auto& s, const Split&) { levels = std::max(levels, s.level + 1); });
    return levels;
}

}  // namespace nestgrid
