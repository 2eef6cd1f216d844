// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <nestgrid/detail/made_for.hpp>
#include <nestgrid/error.hpp>
#include <nestgrid/rule.hpp>

namespace nestgrid {

/// Values at the nodes of a stored grid, by node number, borrowed.
template <class Grid, class Real>
class NodeField {
public:
    using value_type = Real;
    using Element = typename Grid::Element;

    /// \throw InvalidInput where there is not one value per node number
    NodeField(const Grid& grid, std::span<const Real> values)
        : grid_{&grid}, values_{values}, made_for_{grid} {
        if (values.size() != grid.node_count()) {
            throw InvalidInput("the field has " + std::to_string(values.size()) +
                               " values, but the grid " + std::to_string(grid.node_count()) +
                               " nodes");
        }
    }
    NodeField(const Grid& grid, const std::vector<Real>& values)
        : NodeField(grid, std::span<const Real>(values)) {}

    /// \throw GridError where the grid has changed since the field was made
    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        made_for_.require_same(*grid_, "the field");
        const auto nodes = grid_->coarse_grid().element(i);
        for (std::size_t k = 0; k < nodes.size(); ++k) out[k] = values_[nodes[k]];
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask, std::span<Real> out,
                        typename Grid::Context& context) const {
        const std::span<const std::uint32_t> nodes = grid_->new_nodes(e, context);
        for (std::size_t k = 0; k < nodes.size(); ++k) out[k] = values_[nodes[k]];
        return 0;
    }

private:
    const Grid* grid_;
    std::span<const Real> values_;
    detail::MadeFor made_for_;
};

}  // namespace nestgrid
