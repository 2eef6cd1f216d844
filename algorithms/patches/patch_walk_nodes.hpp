// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How PatchWalk asks grid and field for new nodes, their keys and values: eight at once, or in
// rows.
#pragma once

#include <patches/patch_walk.hpp>

namespace nestgrid::engine {

/// Sets ends[b] to whether the ends of patch b are split. Asks about one end of a patch, because
/// the grid splits all of them or none.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::look_whether_split(
    const Batch& batch, std::array<bool, room_>& ends) const {
    const auto& [from, to] = pattern_.parent[pattern_.part[ends_].middle];
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

/// Sets middles[b] = middle(from[b], to[b]) for b in first ... end - 1.
/// Where middle() takes packs, sets all numbers of the packs in which these b lie.
template <class Grid, class Field, class Visitor>
template <class T, class Middle>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::halve(const T* from, const T* to, T* middles,
                                                            std::size_t first, std::size_t end,
                                                            const Middle& middle) {
    if constexpr (Packable<T>) {
        if constexpr (std::is_invocable_v<Middle, const Pack<T>&, const Pack<T>&>) {
            for (std::size_t b = first / pack * pack; b < end; b += pack) {
                middle(Pack<T>::load(from + b), Pack<T>::load(to + b)).store(middles + b);
            }
            return;
        }
    }
    for (std::size_t b = first; b < end; ++b) middles[b] = middle(from[b], to[b]);
}

/// Sets middles[b] to the key of `node` of patch b, from the keys of its parents, as halve() does.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::halve_keys(const Batch& batch,
                                                                 std::size_t node,
                                                                 std::size_t first, std::size_t end,
                                                                 NodeKey* middles) const {
    const auto& [from, to] = pattern_.parent[node];
    halve(batch.keys[from], batch.keys[to], middles, first, end,
          [&](const auto& a, const auto& b)
              NESTGRID_INLINE_LAMBDA -> decltype(grid_->middle_key(a, b)) {
                  return grid_->middle_key(a, b);
              });
}

/// Sets the value at `node` of patches first ... end - 1 to the mean of those at its parents.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::halve_values(Batch& batch, std::size_t node,
                                                                   std::size_t first,
                                                                   std::size_t end) const {
    const auto& [from, to] = pattern_.parent[node];
    halve(batch.values[from], batch.values[to], batch.values[node], first, end,
          [&](const auto& a, const auto& b) NESTGRID_INLINE_LAMBDA -> decltype(field_->mean(a, b)) {
              return field_->mean(a, b);
          });
}

/// Makes the new nodes of all patches but those of the ends, with keys and values, eight patches
/// at once.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::make_nodes(Batch& batch) const {
    const auto each_new_node = [&](auto&& function) NESTGRID_INLINE_LAMBDA {
        for (std::size_t first = 0; first < batch.count; first += pack) {
            unrolled<pattern_.nodes - corners_>([&](auto i) NESTGRID_INLINE_LAMBDA {
                function(std::integral_constant<std::size_t, corners_ + i>{}, first);
            });
        }
    };
    each_new_node([&](auto at, std::size_t first) NESTGRID_INLINE_LAMBDA {
        const auto& [from, to] = pattern_.parent[at];
        halve(batch.nodes[from], batch.nodes[to], batch.nodes[at], first, first + pack,
              [&](const auto& a, const auto& b)
                  NESTGRID_INLINE_LAMBDA -> decltype(grid_->middle(a, b)) {
                      return grid_->middle(a, b);
                  });
        halve_keys(batch, at, first, first + pack, batch.keys[at]);
    });
    for (std::size_t first = 0; first < batch.count; first += pack) {
        constexpr std::size_t unseen = corners_ + 1;
        prefetch(batch.keys[unseen] + first, pattern_.nodes - unseen);
    }
    each_new_node([&](auto at, std::size_t first) NESTGRID_INLINE_LAMBDA {
        if constexpr (GivesMeans<Field>) {
            halve_values(batch, at, first, first + pack);
        } else {
            Pack<Real>::make([&](auto b) NESTGRID_INLINE_LAMBDA {
                return field_->template value_at<!TellsWhereWhole<Grid>>(batch.nodes[at][first + b],
                                                                         batch.keys[at][first + b]);
            }).store(batch.values[at] + first);
        }
    });
}

/// Does the work of make_nodes(), and asks grid and field for whole rows.
template <class Grid, class Field, class Visitor>
void PatchWalk<Grid, Field, Visitor>::ask_for_nodes(Batch& batch) const {
    const auto row = [&](auto* of) { return std::span(of, packed(batch.count)); };
    for (std::size_t at = corners_; at < pattern_.nodes; ++at) {
        const auto& [from, to] = pattern_.parent[at];
        grid_->middles(row(batch.nodes[from]), row(batch.nodes[to]), row(batch.nodes[at]));
        grid_->keys(row(batch.nodes[at]), row(batch.keys[at]));
        for (std::size_t first = 0; at > corners_ && first < batch.count; first += pack) {
            prefetch(batch.keys[at] + first);
        }
    }
    for (std::size_t at = corners_; at < pattern_.nodes; ++at) {
        if constexpr (GivesMeans<Field>) {
            halve_values(batch, at, 0, packed(batch.count));
        } else {
            field_->values_at(row(batch.nodes[at]), row(batch.keys[at]), row(batch.values[at]));
        }
    }
}

/// Sets in_subtree of the nodes that make_nodes() makes. Requires in_subtree of the corners.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void PatchWalk<Grid, Field, Visitor>::number_nodes(Batch& batch) const {
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

/// Finds the keys of the new nodes of the ends of patches first ... end - 1. Requires that these
/// ends are split.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::find_new_nodes(const Batch& batch,
                                                                     std::size_t first,
                                                                     std::size_t end,
                                                                     Ends& ends) const {
    const std::size_t from = first / pack * pack;
    const std::size_t to = packed(end);
    for (std::size_t i = 0; i < ends.keys.size(); ++i) {
        const std::size_t node = pattern_.nodes + i;
        auto& keys = ends.keys[i];
        if constexpr (AnswersInRows<Grid>) {
            const auto& [a, b] = pattern_.parent[node];
            std::array<Node, room_> middles;
            const auto row = [&](auto* of) { return std::span(of + first, end - first); };
            grid_->middles(row(batch.nodes[a]), row(batch.nodes[b]), row(middles.data()));
            grid_->keys(row(middles.data()), row(keys.data()));
        } else {
            halve_keys(batch, node, first, end, keys.data());
        }
        // The ends of other patches in these packs may be leaves: repeats a key for such patches.
        std::fill(keys.begin() + from, keys.begin() + first, keys[first]);
        std::fill(keys.begin() + end, keys.begin() + to, keys[first]);
    }
    for (std::size_t at = from; at < to; at += pack) {
        prefetch(ends.keys[0].data() + at, ends.keys.size());
    }
}

}  // namespace nestgrid::engine
