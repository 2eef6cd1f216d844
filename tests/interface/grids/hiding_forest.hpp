// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest with hidden leaves.
#pragma once

#include <nestgrid/algorithms/hanging_nodes.hpp>

#include "forest.hpp"

namespace nestgrid_test {

/// A forest of which some leaves are hidden, or known to be and drawn all the same.
template <int dim>
class HidingForest : public Forest<dim> {
public:
    using Element = std::uint32_t;

    HidingForest(Forest<dim> forest, std::mt19937&& random)
        : HidingForest(std::move(forest), random) {}
    /// \param hidden_of_four so many of four leaves are hidden, on average
    HidingForest(Forest<dim> forest, std::mt19937& random, unsigned hidden_of_four = 1)
        : Forest<dim>(std::move(forest)), part_(this->cells.size()) {
        for (std::size_t e = this->cells.size(); e-- > 0;) {
            const auto& cell = this->cells[e];
            if (cell.rule == nullptr) {
                part_[e] = random() % 4 < hidden_of_four ? Hidden::wholly : Hidden::not_at_all;
                continue;
            }
            part_[e] = part_[cell.first_child];
            for (std::size_t k = 1; k < cell.rule->children.size(); ++k) {
                if (part_[cell.first_child + k] != part_[e]) part_[e] = Hidden::partly;
            }
        }
        hanging_ = derive_hanging_nodes(*this);
    }
    Hidden hidden(Element e) const {
        return draws_all && part_[e] != Hidden::partly ? Hidden::not_at_all : part_[e];
    }
    NodeMask constrained(Element e) const {
        const auto& cell = this->cells[e];
        NodeMask mask = 0;
        for (std::size_t n = topology(cell.shape).corners, k = 0; n < cell.nodes.size(); ++n, ++k) {
            mask |= NodeMask{hanging_.contains(this->keys[cell.nodes[n]])} << k;
        }
        return mask;
    }

    bool draws_all = false;

private:
    std::vector<Hidden> part_;
    HangingNodes hanging_;
};

}  // namespace nestgrid_test
