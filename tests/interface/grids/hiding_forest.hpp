// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A forest with hidden leaves.
#pragma once

#include <functional>

#include <nestgrid/algorithms/hanging_nodes.hpp>
#include <nestgrid/detail/interpolate.hpp>

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
        : HidingForest(std::move(forest),
                       [&](std::size_t) { return random() % 4 < hidden_of_four; }) {}
    /// \param hides whether a leaf is hidden, given the number of its cell; called from the last
    /// one
    HidingForest(Forest<dim> forest, const std::function<bool(std::size_t leaf)>& hides)
        : Forest<dim>(std::move(forest)), part_(this->cells.size()) {
        for (std::size_t e = this->cells.size(); e-- > 0;) {
            const auto& cell = this->cells[e];
            if (cell.rule == nullptr) {
                part_[e] = hides(e) ? Hidden::wholly : Hidden::not_at_all;
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

    bool hangs(std::uint32_t node) const { return hanging_.contains(this->keys[node]); }

    /// Whether each node is one of hidden leaves alone.
    std::vector<bool> unseen() const {
        std::vector<bool> unseen(this->positions.size(), true);
        for (std::size_t e = 0; e < this->cells.size(); ++e) {
            const auto& cell = this->cells[e];
            if (cell.rule != nullptr || part_[e] == Hidden::wholly) continue;
            for (const std::uint32_t node : cell.nodes) unseen[node] = false;
        }
        return unseen;
    }
    /// Puts at the nodes of hidden leaves alone what the library has there: 0 on the coarse grid,
    /// and interpolants.
    void fill_unseen(std::vector<double>& values) const {
        const std::vector<bool> fill = unseen();
        for (std::size_t i = 0; i < this->coarse_count(); ++i) {
            const auto& cell = this->cells[this->coarse(i).element];
            for (std::size_t k = 0; k < topology(cell.shape).corners; ++k) {
                if (fill[cell.nodes[k]]) values[cell.nodes[k]] = 0;
            }
        }
        for (const auto& cell : this->cells) {
            if (cell.rule == nullptr) continue;
            const std::size_t corners = topology(cell.shape).corners;
            std::vector<double> local;
            for (const std::uint32_t node : cell.nodes) local.push_back(values[node]);
            for (std::size_t n = corners; n < cell.nodes.size(); ++n) {
                if (!fill[cell.nodes[n]]) continue;
                local[n] = nestgrid::detail::interpolate(cell.rule->new_nodes[n - corners],
                                                         local.data(), 1);
                values[cell.nodes[n]] = local[n];
            }
        }
    }

private:
    std::vector<Hidden> part_;
    HangingNodes hanging_;
};

}  // namespace nestgrid_test
