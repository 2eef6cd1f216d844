// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the box that holds a cell, among boxes that do not overlap.
//
// Bins over the hull of the boxes, as wide as the narrowest of them, list the boxes that reach into
// them. They are widened until there are at most 16 for each box, so that memory stays O(boxes).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace nestgrid::detail {

template <int dim>
using BlockPlace = std::array<std::int32_t, static_cast<std::size_t>(dim)>;

/// Cells from `low` to before `high`.
template <int dim>
struct CellRange {
    BlockPlace<dim> low{};
    BlockPlace<dim> high{};

    bool holds(const BlockPlace<dim>& cell) const {
        bool inside = true;
        for (std::size_t d = 0; d < cell.size(); ++d) {
            inside = inside && low[d] <= cell[d] && cell[d] < high[d];
        }
        return inside;
    }
    /// The cells that both have; none where a `high` is not above its `low`.
    CellRange clipped(const CellRange& to) const {
        CellRange part = *this;
        for (std::size_t d = 0; d < low.size(); ++d) {
            part.low[d] = std::max(low[d], to.low[d]);
            part.high[d] = std::min(high[d], to.high[d]);
        }
        return part;
    }
    std::int64_t count() const {
        std::int64_t product = 1;
        for (std::size_t d = 0; d < low.size(); ++d) {
            product *= std::max(0, high[d] - low[d]);
        }
        return product;
    }
};

/// Calls f(place) for the places of a range; for none where it is empty.
template <int dim, class Function>
void for_each_place(const CellRange<dim>& range, Function&& f) {
    if (range.count() == 0) return;
    BlockPlace<dim> at = range.low;
    for (std::size_t d = 0; d < at.size();) {
        f(at);
        for (d = 0; d < at.size() && ++at[d] == range.high[d]; ++d) at[d] = range.low[d];
    }
}

template <int dim>
class BlockFinder {
public:
    using Place = BlockPlace<dim>;
    using Range = CellRange<dim>;

    BlockFinder() = default;
    /// \param boxes that do not overlap, at least one, with numbers from 0 to 2^30
    explicit BlockFinder(std::vector<Range> boxes);

    const std::vector<Range>& boxes() const { return boxes_; }

    /// The number of the box, or -1.
    /// \param guess looked at first; -1 for none
    std::int32_t find(const Place& cell, std::int32_t guess = -1) const {
        if (guess >= 0 && boxes_[static_cast<std::size_t>(guess)].holds(cell)) return guess;
        if (!hull_.holds(cell)) return -1;
        const std::size_t bin = bin_of(cell);
        for (std::size_t i = first_[bin]; i < first_[bin + 1]; ++i) {
            const std::int32_t box = listed_[i];
            if (boxes_[static_cast<std::size_t>(box)].holds(cell)) return box;
        }
        return -1;
    }

    /// Calls f(number of a box, some of its cells in a range) until it answers false; all cells in
    /// boxes come once. Returns whether f never did.
    template <class Function>
    bool for_each_part_within(const Range& range, Function&& f) const {
        bool goes_on = true;
        const Range part = range.clipped(hull_);
        if (part.count() == 0) return true;
        for_each_bin(part, [&](std::size_t bin, const Range& cells) {
            for (std::size_t i = first_[bin]; goes_on && i < first_[bin + 1]; ++i) {
                const Range& box = boxes_[static_cast<std::size_t>(listed_[i])];
                const Range own = part.clipped(cells).clipped(box);
                if (own.count() > 0) goes_on = f(listed_[i], own);
            }
        });
        return goes_on;
    }

    /// How many cells of a range are in boxes.
    std::int64_t count_within(const Range& range) const {
        std::int64_t count = 0;
        const Range part = range.clipped(hull_);
        if (part.count() == 0) return 0;
        for_each_bin(part, [&](std::size_t bin, const Range& cells) {
            for (std::size_t i = first_[bin]; i < first_[bin + 1]; ++i) {
                const Range& box = boxes_[static_cast<std::size_t>(listed_[i])];
                count += part.clipped(cells).clipped(box).count();
            }
        });
        return count;
    }

private:
    static constexpr std::size_t bins_a_box = 16;

    std::size_t bin_of(const Place& cell) const {
        std::size_t bin = 0;
        for (std::size_t d = cell.size(); d-- > 0;) {
            bin = bin * bins_[d] + (static_cast<std::size_t>(cell[d] - hull_.low[d]) >> shift_[d]);
        }
        return bin;
    }
    /// Calls f(bin, its cells) for the bins that a range, which is not empty, reaches into.
    template <class Function>
    void for_each_bin(const Range& range, Function&& f) const;
    void choose_bins();

    std::vector<Range> boxes_;
    Range hull_;
    std::array<unsigned, static_cast<std::size_t>(dim)> shift_{};  // a bin is 2^shift wide
    std::array<std::size_t, static_cast<std::size_t>(dim)> bins_{};
    std::vector<std::size_t> first_{0};  // of each bin in listed_, and the end
    std::vector<std::int32_t> listed_;   // numbers of boxes
};

template <int dim>
BlockFinder<dim>::BlockFinder(std::vector<Range> boxes)
    : boxes_{std::move(boxes)}, hull_{boxes_.front()} {
    for (const Range& box : boxes_) {
        for (std::size_t d = 0; d < box.low.size(); ++d) {
            hull_.low[d] = std::min(hull_.low[d], box.low[d]);
            hull_.high[d] = std::max(hull_.high[d], box.high[d]);
        }
    }
    choose_bins();
    for (const Range& box : boxes_) {
        for_each_bin(box, [&](std::size_t bin, const Range&) { ++first_[bin + 1]; });
    }
    for (std::size_t bin = 1; bin < first_.size(); ++bin) first_[bin] += first_[bin - 1];
    listed_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t b = 0; b < boxes_.size(); ++b) {
        for_each_bin(boxes_[b], [&](std::size_t bin, const Range&) {
            listed_[next[bin]++] = static_cast<std::int32_t>(b);
        });
    }
}

template <int dim>
void BlockFinder<dim>::choose_bins() {
    for (std::size_t d = 0; d < shift_.size(); ++d) {
        std::int32_t least = hull_.high[d] - hull_.low[d];
        for (const Range& box : boxes_) least = std::min(least, box.high[d] - box.low[d]);
        shift_[d] = static_cast<unsigned>(std::bit_width(static_cast<std::uint32_t>(least))) - 1;
    }
    for (;;) {
        double total = 1;
        for (std::size_t d = 0; d < shift_.size(); ++d) {
            bins_[d] =
                (static_cast<std::size_t>(hull_.high[d] - hull_.low[d] - 1) >> shift_[d]) + 1;
            total *= static_cast<double>(bins_[d]);
        }
        if (total <= static_cast<double>(bins_a_box * boxes_.size())) {
            first_.assign(static_cast<std::size_t>(total) + 1, 0);
            return;
        }
        ++shift_[static_cast<std::size_t>(std::max_element(bins_.begin(), bins_.end()) -
                                          bins_.begin())];
    }
}

template <int dim>
template <class Function>
void BlockFinder<dim>::for_each_bin(const Range& range, Function&& f) const {
    Place last = range.high;
    for (std::size_t d = 0; d < last.size(); ++d) --last[d];
    Place at = range.low;
    for (;;) {
        Range cells;
        for (std::size_t d = 0; d < at.size(); ++d) {
            const auto width = std::int32_t{1} << shift_[d];
            cells.low[d] = at[d] - ((at[d] - hull_.low[d]) & (width - 1));
            cells.high[d] = std::min(hull_.high[d] - cells.low[d], width) + cells.low[d];
        }
        f(bin_of(at), cells);
        std::size_t d = 0;
        for (; d < at.size(); ++d) {
            at[d] = cells.high[d];
            if (at[d] <= last[d]) break;
            at[d] = range.low[d];
        }
        if (d == at.size()) return;
    }
}

}  // namespace nestgrid::detail
