// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The preroll by rows of nodes, on grids that know their stars; included by indicator.hpp. What
// comes out is what the sweep of levels gives, to the last bit.
#pragma once

#include <bit>
#include <cstring>

#include <nestgrid/algorithms/indicator.hpp>

namespace nestgrid {

namespace detail {

template <class T>
using Many = std::array<T, 64>;  // for short loops, which become vector instructions

/// As the traversal interpolates, to the last bit.
/// \tparam Number several at once
/// \param at gives them at parent i
template <class Number, class At>
NESTGRID_INLINE Number mean_of_parents(std::size_t parents, const At& at) {
    if (parents == 2) return midpoint<Number>(at(0), at(1));
    if (parents == 4) return face_mean<Number>(at(0), at(1), at(2), at(3));
    return cell_mean(std::array<Number, 8>{at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
}

/// Stop and bound of nodes, four at once.
template <class Field, class Entry>
class StarRows {
public:
    using Real = typename Field::value_type;
    struct Full {  // not rounded
        float stop;
        float bound;
    };

    StarRows(const Field& field, Entry* entries, Full* full)
        : field_{&field}, entries_{entries}, full_{full} {}

    void operator()(const StarRow& row) const {
        for (std::size_t i = 0; i < row.count; i += width_) make(row, i);
    }

private:
    static constexpr std::size_t width_ = 4;
    using Floats = Pack<float, width_>;
    using Pair [[gnu::vector_size(16)]] = float;  // two nodes

    NESTGRID_INLINE Real value(std::size_t node) const {
        return static_cast<Real>(field_->value(static_cast<NodeKey>(node)));
    }
    NESTGRID_INLINE static std::size_t at(std::size_t node, std::ptrdiff_t offset) {
        return node + static_cast<std::size_t>(offset);
    }

    /// Of nodes i and so on; the last one of the row is made several times where there are less.
    NESTGRID_INLINE void make(const StarRow& row, std::size_t i) const {
        std::array<std::size_t, width_> node;
        for (std::size_t k = 0; k < width_; ++k) {
            node[k] = row.first + std::min(i + k, row.count - 1) * row.stride;
        }
        Pair low{};
        Pair high{};
        for (const std::ptrdiff_t offset : row.finer) {
            const Pair a = pair(at(node[0], offset), at(node[1], offset));
            const Pair b = pair(at(node[2], offset), at(node[3], offset));
            low = low > a ? low : a;
            high = high > b ? high : b;
        }
        Floats stop = as_floats(__builtin_shufflevector(low, high, 0, 2, 4, 6));
        Floats bound = as_floats(__builtin_shufflevector(low, high, 1, 3, 5, 7));
        if (!row.parents.empty()) {
            const Floats own = own_offsets(row, node);
            stop = max(stop, own);
            bound = sum_above(own, bound);
        }
        if (i + width_ + row.outside > row.count) {
            stop = Floats::make([&](auto k) {
                const bool outside = std::min(i + k, row.count - 1) + row.outside >= row.count;
                return outside ? std::numeric_limits<float>::infinity() : stop.template number<k>();
            });
        }
        const auto stops = stop.numbers();
        const auto bounds = bound.numbers();
        const auto bits = (bfloat16_above(stop) >> 16 | bfloat16_above(bound)).numbers();
        for (std::size_t k = 0; k < width_; ++k) {
            full_[node[k]] = {stops[k], bounds[k]};
            entries_[node[k]] = {static_cast<std::uint16_t>(bits[k]),
                                 static_cast<std::uint16_t>(bits[k] >> 16U)};
        }
    }

    NESTGRID_INLINE Pair pair(std::size_t node, std::size_t next) const {
        const auto both = [&](std::size_t n)
                              NESTGRID_INLINE_LAMBDA { return std::bit_cast<double>(full_[n]); };
        using Two [[gnu::vector_size(16)]] = double;
        return std::bit_cast<Pair>(Two{both(node), both(next)});
    }
    NESTGRID_INLINE static Floats as_floats(const Pair& four) {
        std::array<float, width_> numbers;
        std::memcpy(&numbers, &four, sizeof four);
        return Floats::load(numbers.data());
    }

    NESTGRID_INLINE Floats own_offsets(const StarRow& row,
                                       const std::array<std::size_t, width_>& node) const {
        using Reals = Pack<Real, width_>;
        const auto values = [&](std::ptrdiff_t offset) NESTGRID_INLINE_LAMBDA -> Reals {
            return Reals::make([&](auto k)
                                   NESTGRID_INLINE_LAMBDA { return value(at(node[k], offset)); });
        };
        const Reals own = values(0);
        const auto mean = mean_of_parents<Reals>(
            row.parents.size(),
            [&](std::size_t parent) NESTGRID_INLINE_LAMBDA { return values(row.parents[parent]); });
        if constexpr (std::is_same_v<Real, float>) {
            return distance_above(own, mean);
        } else {
            return Floats::make([&](auto k) NESTGRID_INLINE_LAMBDA {
                return offset_above(own.template number<k>(), mean.template number<k>());
            });
        }
    }

    const Field* field_;
    Entry* entries_;
    Full* full_;
};

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

/// From one element of each level, for all are split alike.
template <class Grid>
void HierarchicalIndicator::add_splits(const Grid& grid) {
    Context<Grid> context = make_context(grid);
    ElementOf<Grid> element = detail::call_coarse(grid, context, 0).element;
    while (const Rule* rule = detail::call_split(grid, context, element)) {
        facts_.largest_split = std::max(facts_.largest_split, rule->new_nodes.size());
        facts_.all_divided = facts_.all_divided && rule->divides_all;
        ++facts_.finest_level;
        std::array<ElementOf<Grid>, detail::child_capacity<Grid>()> children;
        detail::call_children(grid, context, element,
                              std::span(children).first(rule->children.size()));
        element = children[0];
    }
}

template <class Grid, class Field>
void HierarchicalIndicator::sweep_stars(const Grid& grid, const Field& field) {
    node_count_ = grid.node_count();
    add_splits(grid);
    add_values(field);
    // Nodes of no element are in no row, and count as 0; a whole grid has none.
    bool in_rows = false;
    if constexpr (requires { grid.whole(); }) in_rows = grid.whole();
    using Rows = detail::StarRows<Field, Entry>;
    using Full = typename Rows::Full;
    dense_ = in_rows ? std::make_unique_for_overwrite<Entry[]>(node_count_)
                     : std::make_unique<Entry[]>(node_count_);
    const auto full = in_rows ? std::make_unique_for_overwrite<Full[]>(node_count_)
                              : std::make_unique<Full[]>(node_count_);
    grid.for_each_star_row(Rows(field, dense_.get(), full.get()));
}

}  // namespace nestgrid
