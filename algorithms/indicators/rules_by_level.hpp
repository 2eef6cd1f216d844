// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// The rules by which the elements of each level are split, coarse ones first: those of one element
/// a level, as all of a level are split alike on a grid that knows its stars (StarRow).
template <class Real>
std::vector<const Rule*> rules_by_level(const Hierarchy<Real>& hierarchy) {
    std::vector<const Rule*> rules;
    const std::unique_ptr<Task> task = hierarchy.open();
    Coarse coarse;
    std::array<Family, 2> families;
    hierarchy.coarse(task.get(), 0, coarse, families[0]);
    for (;;) {
        const Member& element = families[rules.size() % 2].members[0];
        if (element.rule == nullptr) return rules;
        rules.push_back(element.rule);
        constexpr NodeMask first_child = 1;
        hierarchy.enter(task.get(), element.element, *element.rule, 0, nullptr, first_child,
                        families[rules.size() % 2]);
    }
}

}  // namespace nestgrid::engine
