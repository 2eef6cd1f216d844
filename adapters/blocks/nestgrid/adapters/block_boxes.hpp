// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The boxes of block-structured adaptive grids, as AMReX, Chombo, Enzo, FLASH and Athena++ have
// them: levels of boxes of cells, each level finer than the one before.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nestgrid/error.hpp>
#include <nestgrid/shape.hpp>

namespace nestgrid {

/// Cells of one level, by their numbers in each direction.
template <int dim>
struct BlockBox {
    std::array<int, static_cast<std::size_t>(dim)> lower{};  ///< the first cell
    std::array<int, static_cast<std::size_t>(dim)> upper{};  ///< the last one, which is included
};

/// Boxes that do not overlap. Cell i of the level before has the cells ratio * i to
/// ratio * i + ratio - 1 of this one; numbers may be negative.
template <int dim>
struct BlockLevel {
    std::vector<BlockBox<dim>> boxes;
    /// To the level before: a power of two, the same in each direction. Not looked at in level 0.
    std::array<int, static_cast<std::size_t>(dim)> ratio{};
};

namespace detail {

template <std::size_t dim>
constexpr std::array<int, dim> first_axes() {
    std::array<int, dim> axes{};
    for (std::size_t d = 0; d < dim; ++d) axes[d] = static_cast<int>(d);
    return axes;
}

}  // namespace detail

/// Level 0 fills a box. Each further level lies within the boxes of the one before, whose cells it
/// replaces.
template <int dim>
struct Blocks {
    std::vector<BlockLevel<dim>> levels;
    Point origin{0, 0, 0};   ///< where the first cell of level 0 begins, in space
    Point spacing{1, 1, 1};  ///< extent of the cells of level 0, by index
    /// The axes of space along which the indices go, ascending: {1, 2} is a plane across x.
    std::array<int, static_cast<std::size_t>(dim)> axes =
        detail::first_axes<static_cast<std::size_t>(dim)>();
};

namespace detail {

/// The quotient, rounded down.
constexpr int floored(int a, int b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }

template <class Number, std::size_t size>
std::string text_of_place(const std::array<Number, size>& place) {
    std::string text = "(";
    for (std::size_t d = 0; d < size; ++d) {
        text += (d == 0 ? "" : ", ") + std::to_string(place[d]);
    }
    return text + ")";
}

}  // namespace detail

/// Adds the boxes that codes have divided and do not store, as Athena++ stores leaves alone: to
/// each level, behind its own boxes, those of the blocks that the finer levels replace, without
/// those that it has. Nothing is ever read in them: arrays of fields are null there.
///
/// \param blocks boxes of one size, each aligned to it, with ratios
/// \throw InvalidInput naming a box that is not, and a block that was replaced in part
template <int dim>
void add_parents(Blocks<dim>& blocks) {
    std::array<int, static_cast<std::size_t>(dim)> size{};
    for (std::size_t l = blocks.levels.size(); l-- > 0;) {
        std::map<std::array<int, static_cast<std::size_t>(dim)>, int> parents;  // their children
        const BlockLevel<dim>& level = blocks.levels[l];
        for (std::size_t b = 0; b < level.boxes.size(); ++b) {
            const BlockBox<dim>& box = level.boxes[b];
            auto parent = box.lower;
            for (std::size_t d = 0; d < parent.size(); ++d) {
                if (size[d] == 0) size[d] = box.upper[d] - box.lower[d] + 1;
                const int n = size[d];
                if (n <= 0 || box.upper[d] - box.lower[d] + 1 != n || box.lower[d] % n != 0) {
                    throw InvalidInput("box " + std::to_string(b) + " of level " +
                                       std::to_string(l) +
                                       " is no block: its size is not that of the others, or it "
                                       "does not begin at a multiple of it");
                }
                if (l > 0 && level.ratio[d] <= 0) {
                    throw InvalidInput("level " + std::to_string(l) + " has no ratio");
                }
                if (l > 0) parent[d] = detail::floored(box.lower[d] / n, level.ratio[d]) * n;
            }
            ++parents[parent];
        }
        if (l == 0) break;
        for (const BlockBox<dim>& box : blocks.levels[l - 1].boxes) parents.erase(box.lower);
        for (const auto& [lower, children] : parents) {
            std::int64_t all = 1;
            for (const int ratio : level.ratio) all *= ratio;
            if (children != all) {
                throw InvalidInput(
                    "level " + std::to_string(l) + " has " + std::to_string(children) + " of the " +
                    std::to_string(all) + " blocks that replace the one from " +
                    detail::text_of_place(lower) + " of level " + std::to_string(l - 1));
            }
            BlockBox<dim> box{lower, lower};
            for (std::size_t d = 0; d < lower.size(); ++d) box.upper[d] += size[d] - 1;
            blocks.levels[l - 1].boxes.push_back(box);
        }
    }
}

}  // namespace nestgrid
