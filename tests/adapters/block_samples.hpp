// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Random blocks, and data in them. What nobody may look at, ghost cells and cells that a finer box
// covers, is not a number.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <random>
#include <set>

#include <nestgrid/adapters/block_fields.hpp>

namespace nestgrid_test {

using namespace nestgrid;

template <int dim>
using Cell = std::array<int, static_cast<std::size_t>(dim)>;

/// Calls f(cell) for the cells of a box.
template <int dim, class Function>
void for_each_cell(const BlockBox<dim>& box, Function&& f) {
    Cell<dim> cell = box.lower;
    for (;;) {
        f(cell);
        std::size_t d = 0;
        while (d < cell.size() && ++cell[d] > box.upper[d]) {
            cell[d] = box.lower[d];
            ++d;
        }
        if (d == cell.size()) return;
    }
}

/// Cuts a box at random, at multiples of a number.
template <int dim>
void cut(const BlockBox<dim>& box, int multiple, std::mt19937& random,
         std::vector<BlockBox<dim>>& out) {
    const std::size_t d = random() % static_cast<std::size_t>(dim);
    const int parts = (box.upper[d] - box.lower[d] + 1) / multiple;
    if (parts < 2 || random() % 4 == 0) {
        out.push_back(box);
        return;
    }
    BlockBox<dim> low = box;
    BlockBox<dim> high = box;
    const int at = 1 + static_cast<int>(random() % static_cast<unsigned>(parts - 1));
    high.lower[d] = box.lower[d] + at * multiple;
    low.upper[d] = high.lower[d] - 1;
    cut(low, multiple, random, out);
    cut(high, multiple, random, out);
}

/// Boxes of the next level within those of one: some of the blocks of `width` cells each that these
/// are made of, cut at random.
template <int dim>
BlockLevel<dim> finer_level(const BlockLevel<dim>& level, int ratio, unsigned rarity, int width,
                            std::mt19937& random) {
    BlockLevel<dim> next;
    next.ratio.fill(ratio);
    for (const BlockBox<dim>& box : level.boxes) {
        std::vector<BlockBox<dim>> parts;
        cut(box, width, random, parts);
        for (BlockBox<dim> part : parts) {
            if (random() % rarity != 0) continue;
            for (std::size_t d = 0; d < part.lower.size(); ++d) {
                part.lower[d] *= ratio;
                part.upper[d] = (part.upper[d] + 1) * ratio - 1;
            }
            cut(part, ratio, random, next.boxes);
        }
    }
    return next;
}

struct RandomBlocks {
    unsigned seed = 1;
    int levels = 3;
    int side = 8;  ///< cells of level 0 along the sides of the unit cube
    unsigned rarity = 3;
    std::array<int, 2> ratios{2, 4};
};

/// On the unit cube or square. Levels meet in any way, neighbours differing by several of them.
template <int dim>
Blocks<dim> random_blocks(const RandomBlocks& wanted) {
    std::mt19937 random(wanted.seed);
    Blocks<dim> blocks;
    BlockBox<dim> all;
    for (std::size_t d = 0; d < all.lower.size(); ++d) {
        all.lower[d] = static_cast<int>(random() % 7) - 3;
        all.upper[d] = all.lower[d] + wanted.side - 1;
        blocks.spacing[d] = 1.0 / wanted.side;
    }
    BlockLevel<dim> level;
    cut(all, 1, random, level.boxes);
    for (int l = 0; l < wanted.levels && !level.boxes.empty(); ++l) {
        std::shuffle(level.boxes.begin(), level.boxes.end(), random);
        blocks.levels.push_back(level);
        level = finer_level(level, wanted.ratios[random() % 2], wanted.rarity, 1, random);
    }
    return blocks;
}

/// The cells of all boxes, with what covers them.
template <int dim>
class CellsOfBlocks {
public:
    explicit CellsOfBlocks(const Blocks<dim>& blocks) : blocks_{&blocks} {
        begin_ = blocks.levels[0].boxes[0].lower;
        for (const BlockBox<dim>& box : blocks.levels[0].boxes) {
            for (std::size_t d = 0; d < begin_.size(); ++d) {
                begin_[d] = std::min(begin_[d], box.lower[d]);
            }
        }
        for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
            covered_.emplace_back();
            ratio_.push_back(l == 0 ? 1 : ratio_[l - 1] * blocks.levels[l].ratio[0]);
            if (l == 0) continue;
            for (BlockBox<dim> box : blocks.levels[l].boxes) {
                for (std::size_t d = 0; d < begin_.size(); ++d) {
                    box.lower[d] =
                        nestgrid::detail::floored(box.lower[d], blocks.levels[l].ratio[d]);
                    box.upper[d] =
                        nestgrid::detail::floored(box.upper[d], blocks.levels[l].ratio[d]);
                }
                for_each_cell(box, [&](const Cell<dim>& c) { covered_[l - 1].insert(c); });
            }
        }
    }
    bool is_leaf(std::size_t level, const Cell<dim>& cell) const {
        return covered_[level].count(cell) == 0;
    }
    /// A place in a cell, or a node, in parts of it.
    Point at(std::size_t level, const Cell<dim>& cell, double part) const {
        Point x = blocks_->origin;
        for (std::size_t d = 0; d < begin_.size(); ++d) {
            x[d] +=
                (cell[d] + part - begin_[d] * ratio_[level]) / ratio_[level] * blocks_->spacing[d];
        }
        return x;
    }
    Point centre(std::size_t level, const Cell<dim>& cell) const { return at(level, cell, 0.5); }

    /// The centres of leaves, in the order of boxes.
    std::vector<Point> centres() const {
        std::vector<Point> all;
        for (std::size_t l = 0; l < blocks_->levels.size(); ++l) {
            for (const BlockBox<dim>& box : blocks_->levels[l].boxes) {
                for_each_cell(box, [&](const Cell<dim>& c) {
                    if (is_leaf(l, c)) all.push_back(centre(l, c));
                });
            }
        }
        return all;
    }

private:
    const Blocks<dim>* blocks_;
    Cell<dim> begin_{};
    std::vector<int> ratio_;  // to level 0
    std::vector<std::set<Cell<dim>>> covered_;
};

/// Arrays of boxes with a number of ghost layers, x fastest.
template <int dim, class Real = double>
class BlockData {
public:
    using Function = std::function<double(const Point&)>;

    /// \param f called at the centres of leaves, in the order of boxes, or at all nodes of boxes
    BlockData(const Blocks<dim>& blocks, const Function& f, int ghosts = 1,
              BlockCentring centring = BlockCentring::cells) {
        const CellsOfBlocks<dim> cells(blocks);
        for (std::size_t l = 0; l < blocks.levels.size(); ++l) {
            arrays_.emplace_back();
            for (const BlockBox<dim>& box : blocks.levels[l].boxes) {
                BlockBox<dim> own = box;
                if (centring == BlockCentring::nodes) {
                    for (int& last : own.upper) ++last;
                }
                BlockBox<dim> stored = own;
                for (std::size_t d = 0; d < stored.lower.size(); ++d) {
                    stored.lower[d] -= ghosts;
                    stored.upper[d] += ghosts;
                }
                // What nobody may read: no number, or a wrong one, in turns.
                const bool is_number = values_.size() % 2 == 1;
                const double unread = is_number ? 1e30 : std::numeric_limits<double>::quiet_NaN();
                auto& values = values_.emplace_back();
                for_each_cell(stored, [&](const Cell<dim>& c) {
                    bool inside = true;
                    for (std::size_t d = 0; d < c.size(); ++d) {
                        inside = inside && own.lower[d] <= c[d] && c[d] <= own.upper[d];
                    }
                    double value = unread;
                    if (centring == BlockCentring::nodes) {
                        if (inside) value = f(cells.at(l, c, 0));
                    } else if (inside && cells.is_leaf(l, c)) {
                        value = f(cells.centre(l, c));
                    }
                    values.push_back(static_cast<Real>(value));
                });
                arrays_.back().push_back(
                    block_array(box, std::span<const Real>(values), ghosts, centring));
            }
        }
    }
    BlockData(const BlockData&) = delete;
    BlockData& operator=(const BlockData&) = delete;
    ~BlockData() = default;

    const BlockArrays<dim, Real>& arrays() const { return arrays_; }

private:
    std::vector<std::vector<Real>> values_;
    BlockArrays<dim, Real> arrays_;
};

/// Values one after the other.
inline std::function<double(const Point&)> in_turn(const std::vector<double>& values) {
    return [&values, next = std::size_t{0}](const Point&) mutable { return values.at(next++); };
}

}  // namespace nestgrid_test
