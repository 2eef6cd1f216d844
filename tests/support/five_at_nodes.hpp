// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A field of five components on a stored hierarchy.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/keys.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid_test {

using namespace nestgrid;

/// Five numbers for each node, by its number.
template <class Grid>
class FiveAtNodes {
public:
    using value_type = double;
    static constexpr int components = 5;

    FiveAtNodes(const Grid& grid, std::vector<std::array<double, 5>> values)
        : grid_{&grid}, values_{std::move(values)} {}

    const std::array<double, 5>& at(NodeKey node) const {
        return values_[static_cast<std::size_t>(node)];
    }
    NodeMask coarse_values(std::size_t i, std::span<double> out) const {
        std::array<NodeKey, max_corners> keys;
        const auto coarse = grid_->coarse(i);
        const auto n = static_cast<std::size_t>(topology(coarse.shape).corners);
        grid_->corner_keys(coarse.element, std::span(keys).first(n));
        for (std::size_t k = 0; k < n; ++k) put(keys[k], out, k);
        return 0;
    }
    NodeMask new_values(const typename Grid::Element& e, NodeMask which, std::span<double> out,
                        typename Grid::Context& context) const {
        const std::span<const std::uint32_t> nodes = grid_->new_nodes(e, context);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            if ((which >> k & 1U) != 0) put(nodes[k], out, k);
        }
        return 0;
    }

private:
    void put(NodeKey node, std::span<double> out, std::size_t k) const {
        std::ranges::copy(at(node), out.begin() + static_cast<std::ptrdiff_t>(5 * k));
    }

    const Grid* grid_;
    std::vector<std::array<double, 5>> values_;
};

}  // namespace nestgrid_test
