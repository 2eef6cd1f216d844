// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Means at nodes are smoother than the data of cells: what the corners of a cell say of its value
// differs from it by a quarter of its second differences. A part of that, brought to the nodes as
// the values were, is taken off.
#include <nestgrid/algorithms/detail/node_means.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <nestgrid/detail/mean.hpp>
#include <ranks/cells_across.hpp>

namespace nestgrid::detail {

namespace {

/// The weight of a corner's value in the value at the centre of gravity.
double part_of_corner(Shape shape, std::size_t corner) {
    if (shape == Shape::pyramid) return corner < 4 ? 3.0 / 16 : 1.0 / 4;
    return 1.0 / topology(shape).corners;
}

/// By what the value of a cell differs from that which its corners have at its centre; 0 where one
/// of them is not finite.
double residual(const NodeMeans& means, const CellWithValue& cell) {
    std::array<double, max_corners> parts{};
    const std::size_t count = cell.keys.size();
    double low = *means.find(cell.keys[0]);
    double high = low;
    for (std::size_t k = 0; k < count; ++k) {
        const double value = *means.find(cell.keys[k]);
        low = std::min(low, value);
        high = std::max(high, value);
        parts[k] = part_of_corner(cell.shape, k) * value;
        if (!std::isfinite(value)) return 0;
    }
    return cell.value - ordered_sum(std::span(parts).first(count), low, high);
}

}  // namespace

void NodeMeans::sharpen(int dimension, const ForEachCell& for_each_cell, double part) {
    std::vector<std::pair<double, double>> range;  // of the cells around, and the value as it is
    for (const double value : values_) range.emplace_back(value, value);
    const auto widen = [&](const CellWithValue& cell) {
        for (const NodeKey key : cell.keys) {
            auto& [low, high] = range[*number_.find(key)];
            low = std::min(low, cell.value);
            high = std::max(high, cell.value);
        }
    };
    const engine::CellsAcross across(shared_, for_each_cell);
    engine::together(shared_, "sharpened means of cells", [&] { for_each_cell(widen); });
    across.for_each(widen);
    const ForEachCell for_each_residual = [&](const auto& visit) {
        for_each_cell([&](CellWithValue cell) {
            cell.value = residual(*this, cell);
            visit(cell);
        });
    };
    const NodeMeans residuals(dimension, for_each_residual, shared_);
    number_.for_each([&](NodeKey key, std::uint32_t n) {
        if (n >= own_ || !std::isfinite(values_[n])) return;
        const double value = values_[n] + part * *residuals.find(key);
        values_[n] = std::clamp(value, range[n].first, range[n].second);
    });
}

}  // namespace nestgrid::detail
