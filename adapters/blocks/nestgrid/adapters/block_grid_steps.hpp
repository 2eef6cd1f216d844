// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of BlockGrid. Included at the end of block_grid.hpp.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

namespace nestgrid {

template <int dim>
BlockGrid<dim>::BlockGrid(const Blocks<dim>& blocks)
    : origin_{blocks.origin}, spacing_{blocks.spacing} {
    detail::BlockChecker<dim> checker(blocks);
    for (std::size_t d = 0; d < size_; ++d) axes_[d] = static_cast<std::size_t>(blocks.axes[d]);
    unsigned steps = 0;
    for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
        if (l > 0) steps += std::min(checker.steps(l), 31U);
        const auto* before = l == 0 ? nullptr : &levels_.back().finder;
        levels_.push_back({steps, detail::BlockFinder<dim>(checker.boxes(l, before, steps)), {}});
    }
    std::uint32_t common = 0;
    for (const auto& box : levels_[0].finder.boxes()) {
        for (std::size_t d = 0; d < size_; ++d) cells_[d] = std::max(cells_[d], box.high[d]);
    }
    for (const std::int32_t n : cells_) common |= static_cast<std::uint32_t>(n);
    const auto above = static_cast<unsigned>(std::countr_zero(common));
    for (std::size_t d = 0; d < size_; ++d) roots_[d] = cells_[d] >> above;
    for (Level& level : levels_) level.depth += above;
    for (unsigned depth = 0; depth <= finest_depth(); ++depth) {
        while (levels_[level_for_[depth]].depth < depth) ++level_for_[depth];
        level_of_[depth] = level_for_[depth];
        if (level_of_[depth] > 0 && levels_[level_of_[depth]].depth > depth) --level_of_[depth];
    }
    const std::vector<Point> nodes = reference_nodes(*rule_);
    for (std::size_t n = 0; n < halves_.size(); ++n) {
        for (std::size_t d = 0; d < size_; ++d) {
            halves_[n][d] = static_cast<std::int32_t>(
                std::lround(2 * nodes[static_cast<std::size_t>(max_corners) + n][d]));
        }
    }
    number_nodes();
    mix_epoch(blocks);
}

template <int dim>
void BlockGrid<dim>::number_nodes() {
    node_count_ = 1;
    for (const std::int32_t n : cells_) node_count_ *= static_cast<std::uint64_t>(n) + 1;
    for (std::size_t l = 1; l < levels_.size(); ++l) {
        for (const auto& box : levels_[l].finder.boxes()) {
            levels_[l].first_node.push_back(node_count_);
            std::uint64_t nodes = 1;
            for (std::size_t d = 0; d < size_; ++d) {
                nodes *= static_cast<std::uint64_t>(box.high[d] - box.low[d]) + 1;
            }
            node_count_ += nodes;
        }
    }
}

template <int dim>
void BlockGrid<dim>::mix_epoch(const Blocks<dim>& blocks) {
    const auto add = [&](int x) {
        epoch_ = detail::mix64(epoch_ + static_cast<std::uint64_t>(std::int64_t{x}));
    };
    for (const BlockLevel<dim>& level : blocks.levels) {
        add(static_cast<int>(level.boxes.size()));
        add(level.ratio[0]);
        for (const BlockBox<dim>& box : level.boxes) {
            for (std::size_t d = 0; d < size_; ++d) {
                add(box.lower[d]);
                add(box.upper[d]);
            }
        }
    }
}

template <int dim>
std::size_t BlockGrid<dim>::coarse_count() const {
    std::size_t count = 1;
    for (const std::int32_t n : roots_) count *= static_cast<std::size_t>(n);
    return count;
}

template <int dim>
auto BlockGrid<dim>::coarse(std::size_t i) const -> CoarseElement<Element> {
    CoarseElement<Element> c;
    c.shape = only_shape;
    for (std::size_t d = 0; d < size_; ++d) {
        c.element.cell[d] = static_cast<std::int32_t>(i % static_cast<std::size_t>(roots_[d]));
        i /= static_cast<std::size_t>(roots_[d]);
    }
    if (levels_[0].depth == 0 && levels_.size() > 1) {
        Place fine = c.element.cell;
        for (std::int32_t& x : fine) x <<= levels_[1].depth;
        c.element.finer = levels_[1].finder.find(fine);
    }
    corner_positions(c.element, c.corners);
    std::array<NodeKey, static_cast<std::size_t>(max_corners)> keys;
    corner_keys(c.element, keys);
    for (std::size_t k = 0; k < keys.size(); ++k) c.ids[k] = static_cast<std::uint64_t>(keys[k]);
    return c;
}

template <int dim>
void BlockGrid<dim>::children(const Element& e, std::span<Element> out) const {
    const unsigned depth = e.depth + 1U;
    const std::size_t level = level_of_[depth];
    const bool is_level = levels_[level].depth == depth;
    std::int32_t found = -1;
    for (std::size_t c = 0; c < out.size(); ++c) {
        out[c].depth = static_cast<std::uint8_t>(depth);
        out[c].finer = e.finer;
        Place fine{};
        for (std::size_t d = 0; d < size_; ++d) {
            out[c].cell[d] = 2 * e.cell[d] + static_cast<std::int32_t>(c >> d & 1U);
            fine[d] = out[c].cell[d];
        }
        if (!is_level) continue;
        out[c].finer = -1;
        if (level + 1 == levels_.size()) continue;
        const Level& next = levels_[level + 1];
        for (std::int32_t& x : fine) x <<= next.depth - depth;
        out[c].finer = next.finder.find(fine, found);
        found = out[c].finer;
    }
}

/// The first box that has a cell around a node.
template <int dim>
std::int32_t BlockGrid<dim>::first_touching(const Level& level, const Place& node,
                                            std::int32_t guess) const {
    if (guess >= 0) {
        const auto& box = level.finder.boxes()[static_cast<std::size_t>(guess)];
        bool inside = true;
        for (std::size_t d = 0; d < size_; ++d) {
            inside = inside && box.low[d] < node[d] && node[d] < box.high[d];
        }
        if (inside) return guess;
    }
    std::int32_t first = -1;
    for (std::size_t k = 0; k < static_cast<std::size_t>(max_corners); ++k) {
        Place cell = node;
        for (std::size_t d = 0; d < size_; ++d) cell[d] -= static_cast<std::int32_t>(k >> d & 1U);
        guess = level.finder.find(cell, guess);
        if (guess >= 0 && (first < 0 || guess < first)) first = guess;
    }
    return first;
}

template <int dim>
auto BlockGrid<dim>::numbering(std::size_t level, std::int32_t box) const -> Numbering {
    if (level == 0) return {0, {{}, cells_}};
    const auto owner = static_cast<std::size_t>(box);
    return {levels_[level].first_node[owner], levels_[level].finder.boxes()[owner]};
}

/// \param node in cells of a depth
/// \param level the coarsest one on whose lattice it lies
/// \param guess a box of the level, or -1
template <int dim>
NodeKey BlockGrid<dim>::key(Place node, unsigned depth, std::size_t level,
                            std::int32_t guess) const {
    const unsigned to = levels_[level].depth;
    for (std::int32_t& x : node) x = depth < to ? x << (to - depth) : x >> (depth - to);
    const std::int32_t owner = level == 0 ? -1 : first_touching(levels_[level], node, guess);
    return numbering(level, owner).key(node);
}

/// A box of a level around an element, or -1: most of its corners lie inside that.
template <int dim>
std::int32_t BlockGrid<dim>::box_around(const Element& e, std::size_t level) const {
    const Level& of = levels_[level];
    if (of.depth > e.depth) return e.finer;
    Place cell = e.cell;
    for (std::int32_t& x : cell) x >>= e.depth - of.depth;
    return of.finder.find(cell);
}

template <int dim>
void BlockGrid<dim>::corner_keys(const Element& e, std::span<NodeKey> out) const {
    constexpr std::int32_t unknown = -2;
    std::array<std::int32_t, 32> around;  // by level
    std::fill_n(around.begin(), levels_.size(), unknown);
    for (std::size_t k = 0; k < out.size(); ++k) {
        Place node = e.cell;
        std::uint32_t all = std::uint32_t{1} << e.depth;
        for (std::size_t d = 0; d < size_; ++d) {
            node[d] += static_cast<std::int32_t>(k >> d & 1U);
            all |= static_cast<std::uint32_t>(node[d]);
        }
        const auto coarsest = e.depth - static_cast<unsigned>(std::countr_zero(all));
        const std::size_t level = level_for_[coarsest];
        std::int32_t& box = around[level];
        if (box == unknown) box = level == 0 ? -1 : box_around(e, level);
        out[k] = key(node, e.depth, level, box);
    }
}

/// New nodes inside one box, or of level 0, are numbered by it, without a search for each.
template <int dim>
void BlockGrid<dim>::new_keys(const Element& e, std::span<NodeKey> out) const {
    const unsigned depth = e.depth + 1U;
    const std::size_t level = level_for_[depth];
    const unsigned steps = levels_[level].depth - depth;
    Place first = e.cell;
    for (std::int32_t& x : first) x <<= steps + 1;
    const Numbering numbers = numbering(level, e.finer);
    bool is_inside = true;
    for (std::size_t d = 0; d < size_; ++d) {
        const std::int32_t last = first[d] + (2 << steps);
        is_inside = is_inside && numbers.box.low[d] < first[d] && last < numbers.box.high[d];
    }
    for (std::size_t n = 0; n < out.size(); ++n) {
        Place node = first;
        for (std::size_t d = 0; d < size_; ++d) node[d] += halves_[n][d] << steps;
        out[n] = level == 0 || is_inside ? numbers.key(node)
                                         : key(node, levels_[level].depth, level, e.finer);
    }
}

template <int dim>
void BlockGrid<dim>::corner_positions(const Element& e, std::span<Point> out) const {
    const double size =
        std::ldexp(1.0, static_cast<int>(levels_[0].depth) - static_cast<int>(e.depth));
    for (std::size_t k = 0; k < static_cast<std::size_t>(max_corners); ++k) {
        out[k] = origin_;
        for (std::size_t d = 0; d < size_; ++d) {
            const auto at = static_cast<double>(e.cell[d] + static_cast<std::int32_t>(k >> d & 1U));
            out[k][axes_[d]] += (at * size) * spacing_[d];
        }
    }
}

/// Whether a cell of the depth of an element is divided, or lies outside the domain.
/// \param beside divided, not above level 0
template <int dim>
bool BlockGrid<dim>::is_divided(const Place& cell, const Element& beside) const {
    const Level& next = levels_[level_of_[beside.depth] + 1U];
    Place fine{};
    for (std::size_t d = 0; d < size_; ++d) {
        if (cell[d] < 0 || cell[d] >= cells_[d] << (beside.depth - levels_[0].depth)) return true;
        fine[d] = cell[d] << (next.depth - beside.depth);
    }
    return next.finder.find(fine, beside.finer) >= 0;
}

/// A node in the middle of an edge or a face hangs where an element around it, as large as this
/// one, is not divided.
template <int dim>
NodeMask BlockGrid<dim>::constrained(const Element& e) const {
    if (e.finer < 0) return 0;
    const Level& next = levels_[level_of_[e.depth] + 1U];
    const auto& box = next.finder.boxes()[static_cast<std::size_t>(e.finer)];
    const auto shift = next.depth - e.depth;
    bool inside = true;
    for (std::size_t d = 0; d < size_; ++d) {
        inside =
            inside && box.low[d] < e.cell[d] << shift && (e.cell[d] + 1) << shift < box.high[d];
    }
    if (inside) return 0;
    NodeMask hanging = 0;
    for (std::size_t n = 0; n < halves_.size(); ++n) {
        // The elements around the node lie off e by parts of the way from its centre to the node.
        for (unsigned part = 1; part < 1U << size_; ++part) {
            Place beside = e.cell;
            bool is_around = true;
            for (std::size_t d = 0; d < size_; ++d) {
                if ((part >> d & 1U) == 0) continue;
                is_around = is_around && halves_[n][d] != 1;
                beside[d] += halves_[n][d] - 1;
            }
            if (is_around && !is_divided(beside, e)) hanging |= NodeMask{1} << n;
        }
    }
    return hanging;
}

}  // namespace nestgrid
