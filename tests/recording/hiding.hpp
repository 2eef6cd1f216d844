// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Forests of which some leaves are hidden.
#pragma once

#include <nestgrid/algorithms/hanging_nodes.hpp>

#include "forests.hpp"

namespace recording {

template <int dim>
class HidingForest : public Forest<dim> {
public:
    using Element = std::uint32_t;

    HidingForest(Forest<dim> forest, unsigned seed)
        : Forest<dim>(std::move(forest)), part_(this->cells.size()) {
        std::mt19937 random(seed);
        for (std::size_t e = this->cells.size(); e-- > 0;) {
            const auto& cell = this->cells[e];
            if (cell.rule == nullptr) {
                part_[e] = random() % 4 == 0 ? Hidden::wholly : Hidden::not_at_all;
                continue;
            }
            part_[e] = part_[cell.first_child];
            for (std::size_t k = 1; k < cell.rule->children.size(); ++k) {
                if (part_[cell.first_child + k] != part_[e]) part_[e] = Hidden::partly;
            }
        }
        hanging_ = derive_hanging_nodes(*this);
    }
    Hidden hidden(Element e) const { return part_[e]; }
    NodeMask constrained(Element e) const {
        const auto& cell = this->cells[e];
        NodeMask mask = 0;
        for (std::size_t n = topology(cell.shape).corners, k = 0; n < cell.nodes.size(); ++n, ++k) {
            mask |= NodeMask{hanging_.contains(this->keys[cell.nodes[n]])} << k;
        }
        return mask;
    }

private:
    std::vector<Hidden> part_;
    HangingNodes hanging_;
};

template <int dim>
void record_hiding(const std::string& name, Forest<dim> forest, double size) {
    const HidingForest<dim> grid(std::move(forest), 7);
    const auto subjects = subjects_on<dim>(grid, size);
    record_preroll(name, grid, subjects);
    record_options(name, grid, subjects);
    record_threads(name, grid, subjects);
}

}  // namespace recording
