// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/hierarchy.hpp>

#include <nestgrid/error.hpp>

namespace nestgrid {

void HierarchyFacts::require_dimension(int wanted) const {
    if (dimension == wanted) return;
    throw InvalidInput("the hierarchy has dimension " + std::to_string(dimension) + ", not " +
                       std::to_string(wanted));
}

void HierarchyFacts::require_one_process(const std::string& what) const {
    if (shared != nullptr) detail::refuse_on_ranks(what);
}

void HierarchyFacts::drop_promises_of_whole_grids() {
    knows_stars = knows_star_positions = fills_rows = false;
    knows_patches = bisects_means = gradients_at_nodes = false;
    if (shared == nullptr) return;
    // Which nodes hang depends on leaves elsewhere, and dense keys count the nodes of all.
    features &=
        ~(static_cast<unsigned>(Feature::constrained) | static_cast<unsigned>(Feature::dense_keys));
    node_count = 0;
}

namespace detail {

void refuse_on_ranks(const std::string& what) {
    throw InvalidInput(what +
                       " is not made for distributed grids yet (docs/distributed.md says what is): "
                       "gather the grid on one process, or do without");
}

void throw_too_many_children(const Rule& rule, std::size_t most) {
    throw GridError("the rule '" + rule.name + "' has " + std::to_string(rule.children.size()) +
                    " children, but the grid's max_children is " + std::to_string(most));
}

}  // namespace detail

}  // namespace nestgrid
