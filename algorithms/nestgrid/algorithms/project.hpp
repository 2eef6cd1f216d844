// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The adaptive projection P_S U as a function on the adaptive grid (paper, sections 2 and 3).
#pragma once

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

namespace detail {

template <class S, class Function>
struct ProjectVisitor {
    const S& criterion;
    Function& extract_element;

    template <class State>
    Decision inspect(const State& s, const Split& split) {
        if (split.rule == nullptr) return {Visit::stop, 0};
        const NodeMask mask =
            criterion(NewNodes{*split.rule, split.keys, s.level + 1, split.outside});
        return {mask == split.rule->all() ? Visit::stop : Visit::descend, mask};
    }
    template <class State>
    void extract(const State& s) {
        extract_element(s);
    }
};

}  // namespace detail

/// Calls function(state) for every element of the adaptive grid, in order; state.value holds P_S U
/// at its corners. `walk` is a Traversal with keys, built with the indicator's hanging nodes.
template <class Walk, Criterion S, class Function>
void project(const Walk& walk, const S& criterion, Function&& function) {
    detail::ProjectVisitor<S, std::remove_reference_t<Function>> visitor{criterion, function};
    walk.run(visitor);
}

}  // namespace nestgrid
