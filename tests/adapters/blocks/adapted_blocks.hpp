// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks that are refined like stored hierarchies, so that the laws of these are those of blocks,
// too: each cell that is marked gets a box of finer ones.
#pragma once

#include <bit>

#include <nestgrid/adapters/block_grid.hpp>

#include "sample_grids.hpp"

namespace nestgrid_test {

/// Blocks on the unit square or cube.
template <int dim>
class AdaptedBlocks : public BlockGrid<dim> {
public:
    using Element = typename BlockGrid<dim>::Element;
    struct Context {
        std::array<std::uint32_t, static_cast<std::size_t>(BlockGrid<dim>::max_new_nodes)> nodes{};
    };
    Context make_context() const { return {}; }

    /// \param side cells of level 0 along each side
    /// \param ratios of level 1, 3, ... and of level 2, 4, ...
    AdaptedBlocks(int side, std::array<int, 2> ratios) : AdaptedBlocks(level_0(side), ratios) {}

    /// Each node number has one; those that no element has are at the origin.
    std::vector<Point> node_positions() const {
        std::vector<Point> positions(this->node_count(), Point{0, 0, 0});
        for_each_element([&](const Element& e) {
            std::array<NodeKey, corners> keys;
            std::array<Point, corners> x;
            this->corner_keys(e, keys);
            this->corner_positions(e, x);
            for (std::size_t k = 0; k < corners; ++k) positions[keys[k]] = x[k];
        });
        return positions;
    }

    /// The roots, whose corners are numbers of nodes.
    CoarseGrid coarse_grid() const {
        CoarseGrid roots;
        roots.dimension = dim;
        for (std::size_t i = 0; i < this->coarse_count(); ++i) {
            std::array<NodeKey, corners> keys;
            this->corner_keys(this->coarse(i).element, keys);
            std::array<std::uint32_t, corners> nodes;
            for (std::size_t k = 0; k < corners; ++k)
                nodes[k] = static_cast<std::uint32_t>(keys[k]);
            roots.add(BlockGrid<dim>::only_shape, nodes);
        }
        return roots;
    }

    /// The numbers of the new nodes of an element.
    std::span<const std::uint32_t> new_nodes(const Element& e, Context& context) const {
        std::array<NodeKey, static_cast<std::size_t>(BlockGrid<dim>::max_new_nodes)> keys;
        this->new_keys(e, keys);
        for (std::size_t n = 0; n < keys.size(); ++n) {
            context.nodes[n] = static_cast<std::uint32_t>(keys[n]);
        }
        return context.nodes;
    }
    /// Divides the leaves for which mark(leaf) says Mark::refine.
    template <class MarkOf>
    void adapt(const MarkOf& mark) {
        Blocks<dim> blocks = blocks_;
        for_each_element([&](const Element& e) {
            if (this->split(e) != nullptr) return;
            std::array<Point, corners> x;
            this->corner_positions(e, x);
            const BlockCell<dim> cell = this->cell_of(e);
            const Leaf leaf{BlockGrid<dim>::only_shape, e.depth - depth_0(), 0, x, {}};
            if (mark(leaf) != Mark::refine) return;
            const auto next = static_cast<std::size_t>(cell.level) + 1;
            const int ratio = ratios_[(next - 1) % 2];
            if (next == blocks.levels.size()) blocks.levels.emplace_back().ratio.fill(ratio);
            BlockBox<dim> box;
            for (std::size_t d = 0; d < box.lower.size(); ++d) {
                box.lower[d] = e.cell[d] * ratio;
                box.upper[d] = box.lower[d] + ratio - 1;
            }
            blocks.levels[next].boxes.push_back(box);
        });
        *this = AdaptedBlocks(std::move(blocks), ratios_);
    }

private:
    static constexpr auto corners = static_cast<std::size_t>(BlockGrid<dim>::max_corners);

    AdaptedBlocks(Blocks<dim> blocks, std::array<int, 2> ratios)
        : BlockGrid<dim>(blocks), blocks_{std::move(blocks)}, ratios_{ratios} {}
    /// Of level 0, below roots that have two cells along each side as often as that divides them.
    int depth_0() const {
        const int side = blocks_.levels[0].boxes[0].upper[0] + 1;
        return std::countr_zero(static_cast<unsigned>(side));
    }
    static Blocks<dim> level_0(int side) {
        Blocks<dim> blocks;
        BlockBox<dim> all;
        all.upper.fill(side - 1);
        blocks.levels.push_back({{all}, {}});
        for (double& step : blocks.spacing) step = 1.0 / side;
        return blocks;
    }
    template <class Visit>
    void for_each_element(const Visit& visit) const {
        for (std::size_t i = 0; i < this->coarse_count(); ++i) {
            for_each_below(this->coarse(i).element, visit);
        }
    }
    template <class Visit>
    void for_each_below(const Element& e, const Visit& visit) const {
        visit(e);
        if (this->split(e) == nullptr) return;
        std::array<Element, corners> children;
        this->children(e, children);
        for (const Element& child : children) for_each_below(child, visit);
    }

    Blocks<dim> blocks_;
    std::array<int, 2> ratios_;
};

}  // namespace nestgrid_test

/// Values by node number.
template <int dim, class Real>
class nestgrid::NodeField<nestgrid_test::AdaptedBlocks<dim>, Real> {
public:
    using Grid = nestgrid_test::AdaptedBlocks<dim>;
    using value_type = Real;
    using Element = typename Grid::Element;

    NodeField(const Grid& grid, std::span<const Real> values) : grid_{&grid}, values_{values} {}

    NodeMask coarse_values(std::size_t i, std::span<Real> out) const {
        std::array<NodeKey, Grid::max_corners> keys;
        grid_->corner_keys(grid_->coarse(i).element, keys);
        for (std::size_t k = 0; k < out.size(); ++k) out[k] = values_[keys[k]];
        return 0;
    }
    NodeMask new_values(const Element& e, NodeMask which, std::span<Real> out,
                        typename Grid::Context& context) const {
        const auto nodes = grid_->new_nodes(e, context);
        for (std::size_t n = 0; n < out.size(); ++n) {
            if ((which >> n & 1U) != 0) out[n] = values_[nodes[n]];
        }
        return 0;
    }

private:
    const Grid* grid_;
    std::span<const Real> values_;
};
