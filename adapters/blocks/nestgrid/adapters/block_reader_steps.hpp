// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Definitions of what reads numbers of boxes. Included at the end of block_fields.hpp.
#pragma once

#include <cmath>

namespace nestgrid {

template <int dim, class Real>
detail::BlockReader<dim, Real>::BlockReader(const BlockGrid<dim>& grid,
                                            BlockArrays<dim, Real> arrays, BlockCentring centring)
    : grid_{&grid}, arrays_{std::move(arrays)} {
    if (arrays_.size() != grid.level_count()) {
        throw InvalidInput("there are arrays of " + std::to_string(arrays_.size()) +
                           " levels, but the grid has " + std::to_string(grid.level_count()));
    }
    const std::int32_t more = centring == BlockCentring::nodes ? 1 : 0;
    for (std::size_t l = 0; l < arrays_.size(); ++l) {
        if (arrays_[l].size() != grid.box_count(l)) {
            throw InvalidInput("level " + std::to_string(l) + " has " +
                               std::to_string(grid.box_count(l)) + " boxes, but " +
                               std::to_string(arrays_[l].size()) + " arrays");
        }
        for (std::size_t b = 0; b < arrays_[l].size(); ++b) {
            const BlockArray<dim, Real>& array = arrays_[l][b];
            if (array.first == nullptr) continue;
            const auto size = grid.box_size(l, b);
            for (std::size_t d = 0; d < size.size(); ++d) {
                const auto stride = array.stride[d];
                const auto step = static_cast<std::ptrdiff_t>(sizeof(Real));
                if (size[d] + more == 1 || stride >= step || stride <= -step) continue;
                throw InvalidInput("the array of box " + std::to_string(b) + " of level " +
                                   std::to_string(l) + " has the stride " + std::to_string(stride) +
                                   " in direction " + std::to_string(d) +
                                   ", less than a number of " + std::to_string(step) + " bytes");
            }
        }
    }
}

template <int dim, class Real>
bool is_leaf_missing(const BlockGrid<dim>& grid, const BlockArrays<dim, Real>& arrays) {
    bool any = false;
    for (std::size_t l = 0; l < arrays.size(); ++l) {
        for (std::size_t b = 0; b < arrays[l].size(); ++b) {
            if (arrays[l][b].first == nullptr) continue;
            BlockCell<dim> cell{static_cast<std::int32_t>(l), static_cast<std::int32_t>(b), {}, {}};
            const detail::CellRange<dim> range{{}, grid.box_size(l, b)};
            detail::for_each_place(range, [&](const detail::BlockPlace<dim>& place) {
                if (any || !std::isnan(arrays[l][b].at(place))) return;
                cell.place = place;
                any = grid.first_leaf(cell).level == cell.level;
            });
        }
    }
    return any;
}

template <int dim, class Real>
template <std::size_t width>
bool detail::BlockReader<dim, Real>::read_patch(const typename BlockGrid<dim>::Element& divided,
                                                PatchNumbers<dim, width>& numbers) const {
    BlockPatch<dim> patch;
    if (!grid_->patch_around(divided, (width - 2) / 2, patch)) return false;
    CellRange<dim> range{patch.low, patch.low};
    for (std::int32_t& x : range.high) x += static_cast<std::int32_t>(width);
    std::size_t i = 0;
    if (patch.is_in_box) {
        const BlockCell<dim> first = grid_->cell_at(patch.level, patch.low, patch.box);
        if (!has(first)) return false;
        for (std::size_t d = 0; d < range.low.size(); ++d) {
            range.high[d] += first.place[d] - range.low[d];
            range.low[d] = first.place[d];
        }
        const BlockArray<dim, Real>& of_box = array(first);
        for_each_place(range, [&](const BlockPlace<dim>& place) {
            numbers[i++] = static_cast<double>(of_box.at(place));
        });
        return true;
    }
    BlockCell<dim> cell;
    cell.box = patch.box;
    bool is_here = true;
    for_each_place(range, [&](const BlockPlace<dim>& place) {
        cell = grid_->cell_at(patch.level, place, cell.box);
        is_here = is_here && has(cell);
        if (is_here) numbers[i++] = static_cast<double>(read(cell));
    });
    return is_here;
}

}  // namespace nestgrid
