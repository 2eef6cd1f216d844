// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What is demanded of blocks. Included by block_grid_steps.hpp.
#pragma once

#include <bit>
#include <cmath>
#include <limits>

namespace nestgrid::detail {

/// A box in numbers that do not overflow; `high` is one behind.
template <int dim>
struct WideBox {
    std::array<std::int64_t, static_cast<std::size_t>(dim)> low{};
    std::array<std::int64_t, static_cast<std::size_t>(dim)> high{};

    explicit WideBox(const BlockBox<dim>& box) {
        for (std::size_t d = 0; d < low.size(); ++d) {
            low[d] = box.lower[d];
            high[d] = std::int64_t{box.upper[d]} + 1;
        }
    }
    double count() const {
        double product = 1;
        for (std::size_t d = 0; d < low.size(); ++d) {
            product *= static_cast<double>(high[d] - low[d]);
        }
        return product;
    }
};

/// Checks levels one after the other, and makes their boxes relative to the first cell of the
/// domain.
template <int dim>
class BlockChecker {
public:
    using Range = CellRange<dim>;

    /// \throw InvalidInput unless the geometry is finite and there are levels
    explicit BlockChecker(const Blocks<dim>& blocks) : blocks_{&blocks} {
        if (blocks.levels.empty()) throw InvalidInput("there are no levels of boxes");
        for (const double x : blocks.origin) {
            if (!std::isfinite(x)) throw InvalidInput("the origin of the boxes is not finite");
        }
        for (std::size_t d = 0; d < size_; ++d) {
            const int before = d == 0 ? -1 : blocks.axes[d - 1];
            if (blocks.axes[d] <= before || blocks.axes[d] > 2) {
                throw InvalidInput("the axes of the boxes are " + text_of_place(blocks.axes) +
                                   ", not ascending from 0 to 2");
            }
            if (!std::isfinite(blocks.spacing[d]) || blocks.spacing[d] <= 0) {
                throw InvalidInput("the spacing of level 0 is " +
                                   std::to_string(blocks.spacing[d]) + " in direction " +
                                   std::to_string(d));
            }
        }
    }

    /// The halvings from the level before to level l, which is not 0.
    /// \throw InvalidInput
    unsigned steps(std::size_t l) const;

    /// The boxes of the next level.
    /// \param before those of the level before, null for level 0
    /// \param steps from level 0
    /// \throw InvalidInput
    std::vector<Range> boxes(std::size_t l, const BlockFinder<dim>* before, unsigned steps);

private:
    static constexpr auto size_ = static_cast<std::size_t>(dim);
    static constexpr std::int64_t widest = std::int64_t{1} << 30U;
    static constexpr double most_cells = 0x1p48;

    using Wide = std::vector<WideBox<dim>>;

    std::string name(std::size_t l, std::size_t b) const {
        const BlockBox<dim>& box = blocks_->levels[l].boxes[b];
        return "box " + std::to_string(b) + " of level " + std::to_string(l) + ", " +
               text_of_place(box.lower) + " to " + text_of_place(box.upper) + ",";
    }
    Wide wide_boxes(std::size_t l) const;
    void refuse_overlaps(std::size_t l, const Wide& boxes) const;
    void refuse_overlap(std::size_t l, const Wide& boxes, std::size_t a, std::size_t b) const;
    void require_box(const Wide& boxes);
    void require_nesting(std::size_t l, const Wide& boxes, const std::vector<Range>& relative,
                         const BlockFinder<dim>& before) const;

    const Blocks<dim>* blocks_;
    std::array<std::int64_t, size_> begin_{};  // of level 0
    std::array<std::int64_t, size_> end_{};
};

template <int dim>
unsigned BlockChecker<dim>::steps(std::size_t l) const {
    const auto& ratio = blocks_->levels[l].ratio;
    const std::string level = "level " + std::to_string(l) + " has the ";
    if (std::any_of(ratio.begin(), ratio.end(), [&](int r) { return r != ratio[0]; })) {
        throw InvalidInput(level + "ratios " + text_of_place(ratio) +
                           ", which differ by direction: one power of two is read");
    }
    if (ratio[0] < 2 || !std::has_single_bit(static_cast<unsigned>(ratio[0]))) {
        throw InvalidInput(level + "ratio " + std::to_string(ratio[0]) + ", not 2, 4, 8, ...");
    }
    return static_cast<unsigned>(std::countr_zero(static_cast<unsigned>(ratio[0])));
}

template <int dim>
auto BlockChecker<dim>::wide_boxes(std::size_t l) const -> Wide {
    const auto& boxes = blocks_->levels[l].boxes;
    if (boxes.empty()) throw InvalidInput("level " + std::to_string(l) + " has no boxes");
    if (boxes.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
        throw InvalidInput("level " + std::to_string(l) + " has more than 2^31 boxes");
    }
    Wide wide;
    double cells = 0;
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        wide.emplace_back(boxes[b]);
        for (std::size_t d = 0; d < size_; ++d) {
            if (wide[b].high[d] <= wide[b].low[d]) throw InvalidInput(name(l, b) + " is empty");
        }
        cells += wide[b].count();
        if (cells > most_cells) {
            throw InvalidInput("level " + std::to_string(l) + " has more than 2^48 cells");
        }
    }
    return wide;
}

template <int dim>
void BlockChecker<dim>::refuse_overlaps(std::size_t l, const Wide& boxes) const {
    std::size_t axis = 0;  // along which the boxes reach farthest
    std::int64_t farthest = -1;
    for (std::size_t d = 0; d < size_; ++d) {
        std::int64_t low = boxes[0].low[d];
        std::int64_t high = boxes[0].high[d];
        for (const WideBox<dim>& box : boxes) {
            low = std::min(low, box.low[d]);
            high = std::max(high, box.high[d]);
        }
        if (high - low > farthest) axis = d;
        farthest = std::max(farthest, high - low);
    }
    std::vector<std::size_t> order(boxes.size());
    for (std::size_t b = 0; b < order.size(); ++b) order[b] = b;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return boxes[a].low[axis] < boxes[b].low[axis];
    });
    std::vector<std::size_t> reached;  // by the plane that moves along the axis
    for (const std::size_t b : order) {
        std::size_t kept = 0;
        for (const std::size_t a : reached) {
            if (boxes[a].high[axis] <= boxes[b].low[axis]) continue;
            refuse_overlap(l, boxes, std::min(a, b), std::max(a, b));
            reached[kept++] = a;
        }
        reached.resize(kept);
        reached.push_back(b);
    }
}

template <int dim>
void BlockChecker<dim>::refuse_overlap(std::size_t l, const Wide& boxes, std::size_t a,
                                       std::size_t b) const {
    std::array<std::int64_t, size_> cell{};
    for (std::size_t d = 0; d < size_; ++d) {
        cell[d] = std::max(boxes[a].low[d], boxes[b].low[d]);
        if (cell[d] >= std::min(boxes[a].high[d], boxes[b].high[d])) return;
    }
    throw InvalidInput("boxes " + std::to_string(a) + " and " + std::to_string(b) + " of level " +
                       std::to_string(l) + " overlap: both have the cell " + text_of_place(cell));
}

/// Of boxes that do not overlap.
template <int dim>
void BlockChecker<dim>::require_box(const Wide& boxes) {
    begin_ = boxes[0].low;
    end_ = boxes[0].high;
    double cells = 0;
    for (const WideBox<dim>& box : boxes) {
        cells += box.count();
        for (std::size_t d = 0; d < size_; ++d) {
            begin_[d] = std::min(begin_[d], box.low[d]);
            end_[d] = std::max(end_[d], box.high[d]);
        }
    }
    WideBox<dim> hull({});
    hull.low = begin_;
    hull.high = end_;
    if (cells == hull.count()) return;
    for (std::int64_t& last : hull.high) --last;
    throw InvalidInput("the boxes of level 0 have holes: they do not fill " +
                       text_of_place(hull.low) + " to " + text_of_place(hull.high));
}

template <int dim>
void BlockChecker<dim>::require_nesting(std::size_t l, const Wide& boxes,
                                        const std::vector<Range>& relative,
                                        const BlockFinder<dim>& before) const {
    const std::int32_t ratio = blocks_->levels[l].ratio[0];
    for (std::size_t b = 0; b < boxes.size(); ++b) {
        Range coarse = relative[b];
        for (std::size_t d = 0; d < size_; ++d) {
            if (boxes[b].low[d] % ratio != 0 || boxes[b].high[d] % ratio != 0) {
                throw InvalidInput(name(l, b) + " cuts cells of level " + std::to_string(l - 1) +
                                   ": it is not aligned to the ratio " + std::to_string(ratio));
            }
            coarse.low[d] /= ratio;
            coarse.high[d] /= ratio;
        }
        if (before.count_within(coarse) != coarse.count()) {
            throw InvalidInput(name(l, b) + " does not lie within the boxes of level " +
                               std::to_string(l - 1));
        }
    }
}

template <int dim>
auto BlockChecker<dim>::boxes(std::size_t l, const BlockFinder<dim>* before, unsigned steps)
    -> std::vector<Range> {
    const Wide wide = wide_boxes(l);
    refuse_overlaps(l, wide);
    if (before == nullptr) require_box(wide);
    std::vector<Range> relative(wide.size());
    for (std::size_t d = 0; d < size_; ++d) {
        const std::int64_t cells = end_[d] - begin_[d];
        if (cells > widest || steps > 30 || cells << steps > widest) {
            throw InvalidInput("level " + std::to_string(l) +
                               " has more than 2^30 cells in direction " + std::to_string(d));
        }
        const std::int64_t begin = begin_[d] * (std::int64_t{1} << steps);
        for (std::size_t b = 0; b < wide.size(); ++b) {
            const std::int64_t low = wide[b].low[d] - begin;
            const std::int64_t high = wide[b].high[d] - begin;
            if (low < 0 || high > cells << steps) {
                throw InvalidInput(name(l, b) + " reaches beyond level 0");
            }
            relative[b].low[d] = static_cast<std::int32_t>(low);
            relative[b].high[d] = static_cast<std::int32_t>(high);
        }
    }
    if (before != nullptr) require_nesting(l, wide, relative, *before);
    return relative;
}

}  // namespace nestgrid::detail
