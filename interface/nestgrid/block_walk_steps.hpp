// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of BlockWalk; included by block_walk.hpp.
#pragma once

#include <nestgrid/block_walk.hpp>

namespace nestgrid {

template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::run(const std::array<Node, 4>& n,
                                          const std::array<Real, 4>& u, int path) {
    constexpr KnownBisection rule = Grid::bisections[last_];
    // The deepest a block can be that is as deep everywhere.
    int blocks = 0;
    for (Node a = n[rule.parent[0]], b = n[rule.parent[1]]; grid_->halved(a, b); ++blocks) {
        b = grid_->middle(a, b);
    }
    const int above_subtree = std::max(0, blocks - subtree_height_);
    subtree_level_ = path / 2 + static_cast<int>(Grid::block_height) * above_subtree;

    Queue first;
    first.begin(*grid_, last_, path / 2);
    first.put_corners(0, n, u, path % 2 != 0);
    for (std::size_t i = 0; i < corners_; ++i) {
        first.sides[i][0] = static_cast<SubtreeFaces>(faces_at(i) << 4U | subtree_faces);
    }
    first.count = 1;
    const auto [lo, hi] = range_of(u);
    const NodeKey middle = grid_->key(grid_->middle(n[rule.parent[0]], n[rule.parent[1]]));
    const auto [visit, bound] =
        visitor_->glance(lo, hi, grid_->rule(last_), middle, path / 2, false);
    if (visit == Visit::stop) extract(Stopped{&first, 0, 1, 0, bound});
    if (visit == Visit::descend) walk(first);
}

/// The blocks of a batch, of which there are the corners, and all below them.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::walk(Queue& batch) {
    if constexpr (in_subtrees_) {
        if (batch.level == subtree_level_) begin_subtrees(batch);
    }
    batch.fill_up();
    if constexpr (AnswersInRows<Grid>) {
        ask_for_nodes(batch);
    } else {
        make_nodes(batch);
    }
    Interior interior;
    look_within(batch, interior);
    std::uint64_t descended = batch.count;
    std::array<bool, room_> split;  // the ends of each
    look_whether_split(batch, split);
    for (std::size_t b = 0; b < batch.count; ++b) {
        const auto& reached = pattern_.reached[static_cast<std::size_t>(interior.descend[b])];
        interior.descend[b] &= reached.interior;
        interior.stop[b] &= reached.interior;
        descended += reached.descended;
    }
    count_->bisect(descended, *visitor_);

    Queue next;
    next.begin(*grid_, last_, batch.level + static_cast<int>(pattern_.height));
    for (std::size_t first = 0, end = 0; first < batch.count; first = end) {
        while (end < batch.count && split[end] == split[first]) ++end;
        if (split[first]) {
            enter(batch, interior, first, end, next);
        } else {
            finish(next);
            extract_leaves(batch, interior, first, end);
        }
    }
    take_stopped(batch, batch.count, [&](const Stopped& element) {
        if (put(element, next)) finish(next);
    });
    finish(next);
}

template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::begin_subtrees(Batch& batch) {
    for (std::size_t i = 0; i < corners_; ++i) {
        for (SubtreeFaces& side : batch.sides[i]) {
            side = static_cast<SubtreeFaces>((side & root_faces) | faces_at(i));
        }
    }
    visitor_->begin_subtrees();
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_within(const Batch& batch,
                                                                  Interior& interior) const {
    using Bits = Pack<MaskOf<Real>>;
    for (std::size_t first = 0; first < batch.count; first += pack) {
        auto descend = Bits::all(0);
        auto stop = Bits::all(0);
        unrolled<ends_ - 2>([&](auto i) NESTGRID_INLINE_LAMBDA {
            constexpr auto part = pattern_.part[i + 2];
            const auto value = [&](std::size_t corner) NESTGRID_INLINE_LAMBDA {
                return Pack<Real>::load(batch.values[part.corner[corner]].data() + first);
            };
            const Pack<Real> u0 = value(0), u1 = value(1), u2 = value(2), u3 = value(3);
            const PackedGlance<Real> glance = visitor_->glance(
                PackedElements<Real>{grid_->rule(part.bisection), batch.level + part.depth,
                                     batch.keys[part.middle].data() + first,
                                     min(min(u0, u1), min(u2, u3)), max(max(u0, u1), max(u2, u3))});
            const auto bit = Bits::all(MaskOf<Real>{1} << i);
            descend = descend | (glance.descend & bit);
            stop = stop | (glance.stop & bit);
            glance.bound.store(interior.bound[i + 2].data() + first);
        });
        descend.store(interior.descend.data() + first);
        stop.store(interior.stop.data() + first);
    }
}

/// Blocks whose ends are leaves.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::extract_leaves(Queue& batch,
                                                                     const Interior& interior,
                                                                     std::size_t first,
                                                                     std::size_t end) {
    Row<std::uint8_t> entered;
    for (std::size_t b = first; b < end; ++b) {
        entered[b] = pattern_.reached[static_cast<std::size_t>(interior.descend[b])].ends;
    }
    Singles singles;
    const auto extract_until = [&](std::size_t b) {
        if (first == b) return;
        extract_singly(batch, interior, singles);
        count_->extracted += visitor_->extract_blocks(batch, first, b, entered.data());
        first = b;
    };
    for (std::size_t b = first; b < end; ++b) {
        if (batch.taken < batch.stopped_count && batch.stopped[batch.taken].before <= b) {
            extract_until(b);
            take_stopped(batch, b, [&](const Stopped& element) {
                singles.block[singles.count] =
                    static_cast<std::uint8_t>(&element - batch.stopped.data());
                singles.part[singles.count++] = Singles::stopped;
            });
        }
        if (interior.stop[b] != 0) {
            extract_until(b);
            singles.append(order_of(interior, b), b);
            first = b + 1;
        }
    }
    extract_until(end);
    extract_singly(batch, interior, singles);
}

template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::extract_singly(const Queue& batch,
                                                                       const Interior& interior,
                                                                       Singles& singles) {
    for (std::size_t i = 0; i < singles.count; ++i) {
        const std::size_t b = singles.block[i];
        const std::size_t part = singles.part[i];
        if (part == Singles::stopped) {
            extract(batch.stopped[b]);
            continue;
        }
        const bool is_end = part >= ends_;
        const Real bound = is_end ? Real(0) : interior.bound[part % ends_][b];
        const bool anything = visitor_->extract_part(batch, b, part, bound);
        count_->extracted += !is_end || anything ? 1 : 0;
    }
    singles.count = 0;
}

/// Blocks whose ends are split.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::enter(Queue& batch, const Interior& interior,
                                                            std::size_t first, std::size_t end,
                                                            Queue& next) {
    Steps steps;
    list(batch, interior, first, end, steps);
    look_at_ends(batch, steps);
    Origins which;
    which.copied = next.count;
    const auto finish_next = [&] {
        copy_corners(batch, which, next);
        finish(next);
    };
    const auto put_stopped = [&](const Stopped& element) {
        if (put(element, next)) finish_next();
    };
    std::size_t next_end = 0;
    // No branch here depends on what was seen: both are written, and counted where they are so.
    for (std::size_t i = 0; i < steps.count; ++i) {
        const std::size_t b = steps.block[i];
        const std::size_t part = steps.part[i];
        take_stopped(batch, b, put_stopped);
        if (next.count == room_) finish_next();
        const bool is_end = part >= ends_;
        const MaskOf<Real> ended = is_end ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        const MaskOf<Real> descends = steps.descend[next_end] & ended;
        const MaskOf<Real> stops = steps.stop[next_end] | ~ended;
        const Real* const bound =
            is_end ? &steps.bound[next_end] : &interior.bound[part % ends_][b];
        next_end += is_end ? 1 : 0;
        which.block[next.count] = static_cast<std::uint8_t>(b);
        which.part[next.count] = static_cast<std::uint8_t>(part);
        next.stopped[next.stopped_count] = {&batch, static_cast<std::uint8_t>(b),
                                            static_cast<std::uint8_t>(part),
                                            static_cast<std::uint8_t>(next.count), *bound};
        next.count += descends & 1U;
        next.stopped_count += stops & 1U;
        if (next.stopped_count == stopped_room_) finish_next();
    }
    take_stopped(batch, end - 1, put_stopped);
    copy_corners(batch, which, next);
}

/// What comes next in these blocks, and what there is to know of the ends.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::list(const Batch& batch,
                                                           const Interior& interior,
                                                           std::size_t first, std::size_t end,
                                                           Steps& steps) const {
    for (std::size_t b = first; b < end; ++b) {
        steps.append(order_of(interior, b), b);
    }
    for (std::size_t i = 0; i < steps.count; ++i) {
        const std::size_t b = steps.block[i];
        const std::size_t part = steps.part[i];
        const auto [lo, hi] = range_within(batch, b, part);
        const auto& parent = parent_of_new_[part];
        steps.lo[steps.end_count] = lo;
        steps.hi[steps.end_count] = hi;
        if constexpr (AnswersInRows<Grid>) {
            steps.from[steps.end_count] = batch.nodes[parent[0]][b];
            steps.to[steps.end_count] = batch.nodes[parent[1]][b];
        } else {
            steps.node[steps.end_count] =
                grid_->middle_key(batch.key(b, parent[0]), batch.key(b, parent[1]));
        }
        steps.end_count += part >= ends_ ? 1 : 0;
    }
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_at_ends(const Batch& batch,
                                                                   Steps& steps) const {
    const std::size_t count = packed(steps.end_count);
    if (steps.end_count > 0) {
        if constexpr (AnswersInRows<Grid>) find_new_nodes(steps);
        const std::size_t last = steps.end_count - 1;
        for (std::size_t i = steps.end_count; i < count; ++i) {
            steps.lo[i] = steps.lo[last];
            steps.hi[i] = steps.hi[last];
            steps.node[i] = steps.node[last];
        }
        for (std::size_t i = 0; i < count; i += pack) {
            const PackedGlance<Real> glance = visitor_->glance(PackedElements<Real>{
                grid_->rule(last_), batch.level + static_cast<int>(pattern_.height),
                steps.node.data() + i, Pack<Real>::load(steps.lo.data() + i),
                Pack<Real>::load(steps.hi.data() + i)});
            glance.descend.store(steps.descend.data() + i);
            glance.stop.store(steps.stop.data() + i);
            glance.bound.store(steps.bound.data() + i);
        }
    }
    steps.descend[steps.end_count] = 0;
    steps.stop[steps.end_count] = 0;
    steps.bound[steps.end_count] = 0;
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::copy_corners(const Batch& batch,
                                                                   Origins& which, Queue& next) {
    for (std::size_t n = which.copied; n < next.count; ++n) {
        const std::size_t b = which.block[n];
        const auto& part = pattern_.part[which.part[n]];
        unrolled<corners_>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const std::size_t from = part.corner[i];
            next.nodes[i][n] = batch.nodes[from][b];
            next.keys[i][n] = batch.keys[from][b];
            next.values[i][n] = batch.values[from][b];
            if constexpr (in_subtrees_) next.sides[i][n] = batch.sides[from][b];
        });
        next.orientations[n] =
            static_cast<std::uint8_t>(batch.orientations[b] ^ (part.mirrored ? 1U : 0U));
    }
    which.copied = 0;
}

template <class Grid, class Field, class Visitor>
bool BlockWalk<Grid, Field, Visitor>::put(const Stopped& element, Queue& next) {
    Stopped& last = next.stopped[next.stopped_count++];
    last = element;
    last.before = static_cast<std::uint8_t>(next.count);
    return next.stopped_count == stopped_room_;
}

/// Walks what was gathered.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::finish(Queue& next) {
    take_stopped(next, 0, [&](const Stopped& element) { extract(element); });
    if (next.count > 0) walk(next);
    next.count = 0;
    next.stopped_count = 0;
    next.taken = 0;
}

}  // namespace nestgrid
