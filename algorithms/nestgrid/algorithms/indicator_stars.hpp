// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll by rows of nodes, on grids that know their stars; included by indicator.hpp. What
// comes out is what the sweep of levels gives, to the last bit.
#pragma once

#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

namespace detail {
using FullEntry [[gnu::vector_size(8)]] = float;  // stop and bound, not rounded
template <class T>
using Many = std::array<T, 64>;  // for short loops, which become vector instructions
}  // namespace detail

/// The same as add_value() of every node.
template <class Field>
void HierarchicalIndicator::add_values(const Field& field) {
    using Real = typename Field::value_type;
    constexpr Real limit = std::numeric_limits<Real>::max() / 8;
    detail::Many<Real> v;
    detail::Many<Real> lo;
    detail::Many<Real> hi;
    detail::Many<std::uint32_t> unusable{};
    lo.fill(std::numeric_limits<Real>::infinity());
    hi.fill(-std::numeric_limits<Real>::infinity());
    for (std::size_t first = 0; first < node_count_; first += v.size()) {
        const std::size_t count = std::min(v.size(), node_count_ - first);
        for (std::size_t k = 0; k < count; ++k) {
            v[k] = static_cast<Real>(field.value(static_cast<NodeKey>(first + k)));
        }
        for (std::size_t k = count; k < v.size(); ++k) v[k] = v[0];
        for (std::size_t k = 0; k < v.size(); ++k) {
            lo[k] = v[k] < lo[k] ? v[k] : lo[k];
            hi[k] = v[k] > hi[k] ? v[k] : hi[k];
            unusable[k] |= std::abs(v[k]) <= limit ? 0U : 1U;
        }
    }
    if (std::ranges::any_of(unusable, [](std::uint32_t u) { return u != 0; })) {
        for (std::size_t i = 0; i < node_count_; ++i) {
            facts_.add_value(static_cast<double>(field.value(static_cast<NodeKey>(i))), limit);
        }
    }
    facts_.least = static_cast<double>(std::ranges::min(lo));
    facts_.greatest = static_cast<double>(std::ranges::max(hi));
}

template <class Grid, class Field>
void HierarchicalIndicator::sweep_stars(const Grid& grid, const Field& field) {
    using Real = typename Field::value_type;
    node_count_ = grid.node_count();
    facts_.all_divided = false;
    facts_.largest_split = 1;  // a star is the midpoint of two nodes, the only one in its elements
    add_values(field);
    // Nodes of no element are in no row, and count as 0; a whole grid has none.
    bool in_rows = false;
    if constexpr (requires { grid.whole(); }) in_rows = grid.whole();
    using Full = detail::FullEntry[];
    dense_ = in_rows ? std::make_unique_for_overwrite<Entry[]>(node_count_)
                     : std::make_unique<Entry[]>(node_count_);
    const auto full = in_rows ? std::make_unique_for_overwrite<Full>(node_count_)
                              : std::make_unique<Full>(node_count_);
    grid.for_each_star_row([&, entries = dense_.get(), full = full.get()](const StarRow& row) {
        const auto value = [&](std::size_t node) {
            return static_cast<Real>(field.value(static_cast<NodeKey>(node)));
        };
        for (std::size_t i = 0; i < row.count; ++i) {
            const std::size_t node = row.first + i * row.stride;
            const auto at = [&](std::ptrdiff_t offset) {
                return node + static_cast<std::size_t>(offset);
            };
            detail::FullEntry finer{};
            for (const std::ptrdiff_t offset : row.finer) {
                const detail::FullEntry there = full[at(offset)];
                finer = finer > there ? finer : there;
            }
            if (row.has_parents) {
                const Real mean = midpoint(value(at(row.parent[0])), value(at(row.parent[1])));
                const float own = detail::offset_above(value(node), mean);
                finer = detail::FullEntry{std::max(finer[0], own), sum_above(own, finer[1])};
            }
            if (i + row.outside >= row.count) finer[0] = std::numeric_limits<float>::infinity();
            full[node] = finer;
            entries[node] = {bfloat16_above(finer[0]), bfloat16_above(finer[1])};
        }
    });
}

}  // namespace nestgrid
