// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of what BlockGrid offers to fields. Included at the end of block_grid.hpp.
#pragma once

#include <algorithm>

namespace nestgrid {

template <int dim>
std::uint64_t BlockGrid<dim>::leaf_count() const {
    std::uint64_t count = 0;
    for (std::size_t l = 0; l < levels_.size(); ++l) {
        const unsigned steps = l == 0 ? 0 : levels_[l].depth - levels_[l - 1].depth;
        for (const auto& box : levels_[l].finder.boxes()) {
            const auto cells = static_cast<std::uint64_t>(box.count());
            count += cells - (l == 0 ? 0 : cells >> (steps * size_));
        }
    }
    return count;
}

/// Each node counts in the box that it belongs to, where it lies on no coarser lattice.
template <int dim>
std::uint64_t BlockGrid<dim>::used_node_count() const {
    std::uint64_t count = 1;
    for (const std::int32_t n : cells_) count *= static_cast<std::uint64_t>(n) + 1;
    for (std::size_t l = 1; l < levels_.size(); ++l) {
        const std::int32_t ratio = std::int32_t{1} << (levels_[l].depth - levels_[l - 1].depth);
        const auto& boxes = levels_[l].finder.boxes();
        for (std::size_t b = 0; b < boxes.size(); ++b) {
            std::uint64_t all = 1;
            std::uint64_t coarse = 1;
            for (std::size_t d = 0; d < size_; ++d) {
                const std::int32_t cells = boxes[b].high[d] - boxes[b].low[d];
                all *= static_cast<std::uint64_t>(cells - 1);
                coarse *= static_cast<std::uint64_t>(cells / ratio - 1);
            }
            count +=
                all - coarse + owned_at_border(levels_[l], static_cast<std::int32_t>(b), ratio);
        }
    }
    return count;
}

/// How many nodes on the border of a box belong to it and lie on no coarser lattice.
template <int dim>
std::uint64_t BlockGrid<dim>::owned_at_border(const Level& level, std::int32_t box,
                                              std::int32_t ratio) const {
    const auto& range = level.finder.boxes()[static_cast<std::size_t>(box)];
    std::uint64_t count = 0;
    const auto look = [&](const Place& node) {
        bool is_coarse = true;
        for (const std::int32_t x : node) is_coarse = is_coarse && x % ratio == 0;
        if (!is_coarse && first_touching(level, node, box) == box) ++count;
    };
    // Each node with the first direction in which it is at an end.
    for (std::size_t d = 0; d < size_; ++d) {
        for (const std::int32_t end : {range.low[d], range.high[d]}) {
            detail::CellRange<dim> side = range;
            for (std::size_t e = 0; e < size_; ++e) {
                if (e < d) ++side.low[e];
                if (e > d) ++side.high[e];
            }
            side.low[d] = end;
            side.high[d] = end + 1;
            detail::for_each_place(side, look);
        }
    }
    return count;
}

template <int dim>
template <class Function>
void BlockGrid<dim>::for_each_box_below(const Element& e, Function&& f) const {
    if (split(e) == nullptr) {
        const BlockCell<dim> cell = cell_of(e);
        f(static_cast<std::size_t>(cell.level), static_cast<std::size_t>(cell.box));
        return;
    }
    const auto finer = [](detail::CellRange<dim> range, unsigned steps) {
        for (std::size_t d = 0; d < size_; ++d) {
            range.low[d] <<= steps;
            range.high[d] <<= steps;
        }
        return range;
    };
    detail::CellRange<dim> whole{e.cell, e.cell};
    for (std::int32_t& x : whole.high) ++x;
    std::size_t l = e.depth < levels_[0].depth ? 0 : level_of_[e.depth] + std::size_t{1};
    for (bool goes_on = true; goes_on && l < levels_.size(); ++l) {
        const Level& level = levels_[l];
        const Level* const next = l + 1 < levels_.size() ? &levels_[l + 1] : nullptr;
        goes_on = level.finder.for_each_part_within(
            finer(whole, level.depth - e.depth),
            [&](std::int32_t box, const detail::CellRange<dim>& cells) {
                if (next != nullptr) {
                    const auto below = finer(cells, next->depth - level.depth);
                    if (next->finder.count_within(below) == below.count()) return true;
                }
                return f(l, static_cast<std::size_t>(box));
            });
    }
}

template <int dim>
auto BlockGrid<dim>::box_size(std::size_t level, std::size_t box) const -> Place {
    const auto& range = levels_[level].finder.boxes()[box];
    Place size{};
    for (std::size_t d = 0; d < size_; ++d) size[d] = range.high[d] - range.low[d];
    return size;
}

template <int dim>
auto BlockGrid<dim>::finest_size() const -> Place {
    Place size = cells_;
    for (std::int32_t& n : size) n <<= finest_depth() - levels_[0].depth;
    return size;
}

template <int dim>
auto BlockGrid<dim>::place(NodeKey key) const -> Node {
    auto rest = static_cast<std::uint64_t>(key);
    std::size_t level = levels_.size() - 1;
    const auto begins_behind = [&](const Level& of) {
        return of.first_node.empty() || rest < of.first_node.front();
    };
    while (level > 0 && begins_behind(levels_[level])) --level;
    Node node;
    node.near.level = static_cast<std::int32_t>(level);
    detail::CellRange<dim> range{{}, cells_};
    if (level > 0) {
        const auto& first = levels_[level].first_node;
        const auto box = std::ranges::upper_bound(first, rest) - first.begin() - 1;
        node.near.box = static_cast<std::int32_t>(box);
        rest -= first[static_cast<std::size_t>(box)];
        range = levels_[level].finder.boxes()[static_cast<std::size_t>(box)];
    }
    for (std::size_t d = 0; d < size_; ++d) {
        const auto count = static_cast<std::uint64_t>(range.high[d] - range.low[d]) + 1;
        node.place[d] = (range.low[d] + static_cast<std::int32_t>(rest % count)) * extent(level);
        rest /= count;
    }
    if (level == 0) {
        Place cell = node.place;
        for (std::size_t d = 0; d < size_; ++d) {
            cell[d] = std::min(cell[d] / extent(0), cells_[d] - 1);
        }
        node.near.box = levels_[0].finder.find(cell);
    }
    return node;
}

template <int dim>
auto BlockGrid<dim>::new_node(const Element& e, std::size_t n) const -> Place {
    Place node{};
    for (std::size_t d = 0; d < size_; ++d) {
        node[d] = (2 * e.cell[d] + halves_[n][d]) << (finest_depth() - e.depth - 1);
    }
    return node;
}

template <int dim>
auto BlockGrid<dim>::corner(const Element& e, std::size_t k) const -> Place {
    Place node{};
    for (std::size_t d = 0; d < size_; ++d) {
        node[d] = (e.cell[d] + static_cast<std::int32_t>(k >> d & 1U))
                  << (finest_depth() - e.depth);
    }
    return node;
}

template <int dim>
BlockCell<dim> BlockGrid<dim>::cell_of(const Element& leaf) const {
    return cell_at(level_of_[leaf.depth], leaf.cell, -1);
}

/// Looks into the boxes that are guessed first, the finest before the others, and into finer levels
/// from there on.
/// \param cell finest, inside the domain
/// \param guess a box of each level, or -1; those that are found are put there
template <int dim>
BlockCell<dim> BlockGrid<dim>::leaf_at(const Place& cell, std::span<std::int32_t> guess) const {
    const auto at = [&](std::size_t l) {
        Place place = cell;
        for (std::int32_t& x : place) x >>= finest_depth() - levels_[l].depth;
        return place;
    };
    const auto is_guessed = [&](std::size_t l) {
        if (guess[l] < 0) return false;
        return levels_[l].finder.boxes()[static_cast<std::size_t>(guess[l])].holds(at(l));
    };
    std::size_t level = levels_.size() - 1;
    while (level > 0 && !is_guessed(level)) --level;
    guess[level] = levels_[level].finder.find(at(level), guess[level]);
    for (; level + 1 < levels_.size(); ++level) {
        const std::int32_t finer = levels_[level + 1].finder.find(at(level + 1), -1);
        if (finer < 0) break;
        guess[level + 1] = finer;
    }
    const Place place = at(level);
    BlockCell<dim> leaf{static_cast<std::int32_t>(level), guess[level], place, place};
    const auto& range = levels_[level].finder.boxes()[static_cast<std::size_t>(leaf.box)];
    for (std::size_t d = 0; d < size_; ++d) {
        leaf.place[d] -= range.low[d];
        leaf.low[d] <<= finest_depth() - levels_[level].depth;
    }
    return leaf;
}

template <int dim>
BlockCell<dim> BlockGrid<dim>::leaf_at(const Place& cell, const BlockCell<dim>& near) const {
    std::array<std::int32_t, 32> guess;
    std::fill_n(guess.begin(), levels_.size(), -1);
    if (near.box >= 0) guess[static_cast<std::size_t>(near.level)] = near.box;
    return leaf_at(cell, std::span(guess));
}

template <int dim>
BlockCell<dim> BlockGrid<dim>::first_leaf(const BlockCell<dim>& cell) const {
    const auto l = static_cast<std::size_t>(cell.level);
    Place first = levels_[l].finder.boxes()[static_cast<std::size_t>(cell.box)].low;
    for (std::size_t d = 0; d < size_; ++d) {
        first[d] = (first[d] + cell.place[d]) << (finest_depth() - levels_[l].depth);
    }
    return leaf_at(first, cell);
}

template <int dim>
bool BlockGrid<dim>::patch_around(const Element& divided, std::int32_t layers,
                                  BlockPatch<dim>& patch) const {
    const std::size_t l = level_of_[divided.depth + 1U];
    const Level& level = levels_[l];
    if (level.depth != divided.depth + 1U) return false;
    detail::CellRange<dim> range;
    Place middle{};
    for (std::size_t d = 0; d < size_; ++d) {
        middle[d] = 2 * divided.cell[d];
        range.low[d] = middle[d] - layers;
        range.high[d] = middle[d] + 2 + layers;
    }
    patch.level = static_cast<std::int32_t>(l);
    patch.box = l == 0 ? level.finder.find(middle) : divided.finer;
    patch.low = range.low;
    const auto& box = level.finder.boxes()[static_cast<std::size_t>(patch.box)];
    patch.is_in_box = range.clipped(box).count() == range.count();
    patch.is_whole = patch.is_in_box || level.finder.count_within(range) == range.count();
    patch.has_finer = false;
    if (l + 1 == levels_.size()) return true;
    const Level& next = levels_[l + 1];
    for (std::size_t d = 0; d < size_; ++d) {
        range.low[d] <<= next.depth - level.depth;
        range.high[d] <<= next.depth - level.depth;
    }
    patch.has_finer = next.finder.count_within(range) != 0;
    patch.is_whole = patch.is_whole && !patch.has_finer;
    return true;
}

template <int dim>
template <class Function>
void BlockGrid<dim>::for_each_part(const BlockPatch<dim>& patch, std::int32_t side,
                                   Function&& f) const {
    detail::CellRange<dim> range{patch.low, patch.low};
    for (std::int32_t& x : range.high) x += side;
    const auto& finder = levels_[static_cast<std::size_t>(patch.level)].finder;
    finder.for_each_part_within(range, [&](std::int32_t box, const detail::CellRange<dim>& part) {
        f(cell_at(patch.level, part.low, box), part);
        return true;
    });
}

template <int dim>
template <class Function>
void BlockGrid<dim>::for_each_covered(const BlockPatch<dim>& patch, std::int32_t side,
                                      Function&& f) const {
    if (!patch.has_finer) return;
    const Level& next = levels_[static_cast<std::size_t>(patch.level) + 1];
    const unsigned steps = next.depth - levels_[static_cast<std::size_t>(patch.level)].depth;
    detail::CellRange<dim> range{patch.low, patch.low};
    for (std::size_t d = 0; d < size_; ++d) {
        range.low[d] <<= steps;
        range.high[d] = (patch.low[d] + side) << steps;
    }
    next.finder.for_each_part_within(range, [&](std::int32_t, detail::CellRange<dim> part) {
        for (std::size_t d = 0; d < size_; ++d) {  // boxes are aligned, bins need not be
            part.low[d] >>= steps;
            part.high[d] = ((part.high[d] - 1) >> steps) + 1;
        }
        detail::for_each_place(part, f);
        return true;
    });
}

template <int dim>
BlockCell<dim> BlockGrid<dim>::cell_at(std::int32_t level, const Place& cell,
                                       std::int32_t guess) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    BlockCell<dim> found{level, of.finder.find(cell, guess), cell, cell};
    if (found.box < 0) return found;
    const auto& box = of.finder.boxes()[static_cast<std::size_t>(found.box)];
    for (std::size_t d = 0; d < size_; ++d) {
        found.place[d] -= box.low[d];
        found.low[d] <<= finest_depth() - of.depth;
    }
    return found;
}

/// Whether a node has a box all around it, with cells that are leaves and have it for a corner;
/// these are written then.
template <int dim>
bool BlockGrid<dim>::is_within(const Place& node, const BlockCell<dim>& near,
                               Around& around) const {
    const auto l = static_cast<std::size_t>(near.level);
    const auto& box = levels_[l].finder.boxes()[static_cast<std::size_t>(near.box)];
    const unsigned shift = finest_depth() - levels_[l].depth;
    Place at = node;
    for (std::size_t d = 0; d < size_; ++d) {
        at[d] >>= shift;
        if (at[d] << shift != node[d] || at[d] <= box.low[d] || at[d] >= box.high[d]) return false;
    }
    if (l + 1 < levels_.size()) {
        const Level& next = levels_[l + 1];
        detail::CellRange<dim> finer;
        for (std::size_t d = 0; d < size_; ++d) {
            finer.low[d] = (at[d] - 1) << (next.depth - levels_[l].depth);
            finer.high[d] = (at[d] + 1) << (next.depth - levels_[l].depth);
        }
        if (next.finder.count_within(finer) != 0) return false;
    }
    for (std::size_t k = 0; k < around.size(); ++k) {
        around[k].level = near.level;
        around[k].box = near.box;
        for (std::size_t d = 0; d < size_; ++d) {
            const std::int32_t cell = at[d] - ((k >> d & 1U) == 0 ? 1 : 0);
            around[k].place[d] = cell - box.low[d];
            around[k].low[d] = cell << shift;
        }
    }
    return true;
}

template <int dim>
auto BlockGrid<dim>::leaves_around(const Place& node, const BlockCell<dim>& near) const -> Around {
    Around around;
    if (near.box >= 0 && is_within(node, near, around)) return around;
    const Place size = finest_size();
    std::array<std::int32_t, 32> guess;  // a box of each level
    std::fill_n(guess.begin(), levels_.size(), -1);
    if (near.box >= 0) guess[static_cast<std::size_t>(near.level)] = near.box;
    for (std::size_t k = 0; k < around.size(); ++k) {
        Place cell = node;
        bool is_inside = true;
        for (std::size_t d = 0; d < size_; ++d) {
            cell[d] -= (k >> d & 1U) == 0 ? 1 : 0;
            is_inside = is_inside && 0 <= cell[d] && cell[d] < size[d];
        }
        if (!is_inside) continue;
        around[k] = leaf_at(cell, guess);
        const bool is_elsewhere = around[k].level != near.level || around[k].box != near.box;
        if (k == 0 && is_elsewhere && is_within(node, around[0], around)) return around;
    }
    return around;
}

}  // namespace nestgrid
