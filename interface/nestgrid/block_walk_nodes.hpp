// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What BlockWalk asks of grid and field: new nodes, their keys and values, eight at once or in
// rows; included by block_walk.hpp.
#pragma once

#include <nestgrid/block_walk.hpp>

namespace nestgrid {

/// One end of a block says it for all of them.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_whether_split(
    const Batch& batch, std::array<bool, room_>& ends) const {
    const auto& [from, to] = parent_of_new_[ends_];
    if constexpr (AnswersInRows<Grid>) {
        std::array<Node, room_> between;
        grid_->perhaps_middles(std::span(batch.nodes[from], batch.count),
                               std::span(batch.nodes[to], batch.count),
                               std::span(between).first(batch.count));
        for (std::size_t b = 0; b < batch.count; ++b) ends[b] = between[b] != Grid::no_node;
    } else {
        for (std::size_t b = 0; b < batch.count; ++b) {
            ends[b] = grid_->halved(batch.nodes[from][b], batch.nodes[to][b]);
        }
    }
}

/// Eight of a row of rows: what lies in the middle of two others.
template <class Grid, class Field, class Visitor>
template <class Rows, class Middle>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::halve(Rows& rows, std::size_t at,
                                                            std::size_t first,
                                                            const Middle& middle) {
    using T = std::remove_cvref_t<decltype(rows[0][0])>;
    const T* const from = rows[pattern_.parent[at][0]];
    const T* const to = rows[pattern_.parent[at][1]];
    if constexpr (Packable<T>) {
        if constexpr (std::is_invocable_v<Middle, const Pack<T>&, const Pack<T>&>) {
            return middle(Pack<T>::load(from + first), Pack<T>::load(to + first))
                .store(rows[at] + first);
        }
    }
    for (std::size_t b = first; b < first + pack; ++b) rows[at][b] = middle(from[b], to[b]);
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::make_nodes(Batch& batch) const {
    const auto each_new_node = [&](auto&& function) NESTGRID_INLINE_LAMBDA {
        for (std::size_t first = 0; first < batch.count; first += pack) {
            unrolled<pattern_.nodes - corners_>([&](auto i) NESTGRID_INLINE_LAMBDA {
                function(std::integral_constant<std::size_t, corners_ + i>{}, first);
            });
        }
    };
    each_new_node([&](auto at, std::size_t first) NESTGRID_INLINE_LAMBDA {
        halve(batch.nodes, at, first,
              [&](const auto& a, const auto& b)
                  NESTGRID_INLINE_LAMBDA -> decltype(grid_->middle(a, b)) {
                      return grid_->middle(a, b);
                  });
        halve(batch.keys, at, first,
              [&](const auto& a, const auto& b)
                  NESTGRID_INLINE_LAMBDA -> decltype(grid_->middle_key(a, b)) {
                      return grid_->middle_key(a, b);
                  });
    });
    each_new_node([&](auto at, std::size_t first)
                      NESTGRID_INLINE_LAMBDA { expect(batch.keys[at] + first); });
    each_new_node([&](auto at, std::size_t first) NESTGRID_INLINE_LAMBDA {
        Pack<Real>::make([&](auto b) NESTGRID_INLINE_LAMBDA {
            return field_->template value_at<!TellsWhereWhole<Grid>>(batch.nodes[at][first + b],
                                                                     batch.keys[at][first + b]);
        }).store(batch.values[at] + first);
    });
}

/// The same in rows.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::ask_for_nodes(Batch& batch) const {
    const auto row = [&](auto* of) { return std::span(of, packed(batch.count)); };
    for (std::size_t at = corners_; at < pattern_.nodes; ++at) {
        const auto& [from, to] = pattern_.parent[at];
        grid_->middles(row(batch.nodes[from]), row(batch.nodes[to]), row(batch.nodes[at]));
        grid_->keys(row(batch.nodes[at]), row(batch.keys[at]));
        for (std::size_t first = 0; first < batch.count; first += pack) {
            expect(batch.keys[at] + first);
        }
    }
    for (std::size_t at = corners_; at < pattern_.nodes; ++at) {
        field_->values_at(row(batch.nodes[at]), row(batch.keys[at]), row(batch.values[at]));
    }
}

/// What is known of them in subtrees.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::number_nodes(Batch& batch) const {
    constexpr int height = InSubtree::height * static_cast<int>(pattern_.height);
    const bool below = batch.level >= subtree_level_ + height;
    for (std::size_t at = corners_; at < pattern_.nodes; ++at) {
        const SubtreeNode* const from = batch.in_subtree[pattern_.parent[at][0]];
        const SubtreeNode* const to = batch.in_subtree[pattern_.parent[at][1]];
        for (std::size_t first = 0; first < batch.count; first += pack) {
            const auto a = Pack<SubtreeNode>::load(from + first);
            const auto b = Pack<SubtreeNode>::load(to + first);
            (below ? InSubtree::middle_below(a, b) : InSubtree::middle(a, b))
                .store(batch.in_subtree[at] + first);
        }
    }
}

/// Of ends, in rows.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::find_new_nodes(Steps& steps) const {
    const std::span<Node> from(steps.from.data(), steps.end.count);
    grid_->middles(from, std::span(steps.to).first(from.size()), from);
    grid_->keys(from, std::span(steps.node).first(from.size()));
}

}  // namespace nestgrid
