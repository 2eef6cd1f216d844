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
    const int above_subtree = std::max(0, blocks - InSubtree::height);
    subtree_level_ = path / 2 + static_cast<int>(Grid::block_height) * above_subtree;

    Queue first;
    first.begin(*grid_, path / 2);
    first.put_corners(0, n, u, path % 2 != 0);
    for (std::size_t i = 0; i < corners_; ++i) {
        first.in_subtree[i][0] = InSubtree::root_corner(i);
    }
    first.count = 1;
    const auto [lo, hi] = range_of(u);
    const NodeKey middle = grid_->key(grid_->middle(n[rule.parent[0]], n[rule.parent[1]]));
    const auto [visit, bound] =
        visitor_->glance(lo, hi, grid_->rule(last_), middle, path / 2, false);
    if (visit == Visit::stop) {
        BatchSelection selection;
        select(first, {&first, 0, 1, 0, bound}, selection);
        extract(first, selection);
    }
    if (visit == Visit::descend) walk(first);
}

/// The blocks of a batch, of which there are the corners, and all below them.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::walk(Queue& batch) {
    batch.fill_up();
    if constexpr (in_subtrees_) {
        if (visitor_->names_edges()) {
            if (batch.level == subtree_level_) begin_subtrees(batch);
            number_nodes(batch);
        }
    }
    if constexpr (AnswersInRows<Grid>) {
        ask_for_nodes(batch);
    } else {
        make_nodes(batch);
    }
    look_within(batch);
    std::uint64_t descended = batch.count;
    std::array<bool, room_> split;  // the ends of each
    look_whether_split(batch, split);
    const std::size_t count = batch.count;
    for (std::size_t b = 0; b < count; ++b) {
        const auto& reached = pattern_.reached[static_cast<std::size_t>(batch.entered[b])];
        const MaskOf<Real> entered = batch.entered[b] & reached.interior;
        const MaskOf<Real> stops = batch.stops[b] & reached.interior;
        batch.entered[b] = entered;
        batch.stops[b] = stops;
        batch.ends[b] = reached.ends;
        const unsigned any = stops != 0 ? ~0U : 0U;
        batch.undivided[b] =
            static_cast<std::uint8_t>(~static_cast<unsigned>(entered) & interior_ & any);
        descended += reached.descended;
    }
    count_->bisect(descended, *visitor_);

    Queue next;
    next.begin(*grid_, batch.level + static_cast<int>(pattern_.height));
    for (std::size_t first = 0, end = 0; first < batch.count; first = end) {
        while (end < batch.count && split[end] == split[first]) ++end;
        if (split[first]) {
            enter(batch, first, end, next);
        } else {
            finish(next);
            extract_blocks(batch, first, end, true);
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
        SubtreeNode* const nodes = batch.in_subtree[i];
        for (std::size_t b = 0; b < batch.count; ++b) nodes[b] = InSubtree::corner(nodes[b], b, i);
    }
    visitor_->begin_subtrees(InSubtree::edge_numbers(batch.count));
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_within(Queue& batch) const {
    using Bits = Pack<MaskOf<Real>>;
    for (std::size_t first = 0; first < batch.count; first += pack) {
        auto descend = Bits::all(0);
        auto stop = Bits::all(0);
        auto greatest = Pack<Real>::all(0);
        unrolled<ends_ - 2>([&](auto i) NESTGRID_INLINE_LAMBDA {
            constexpr auto part = pattern_.part[i + 2];
            const auto [lo, hi] = range_within<i + 2>(batch, first);
            const PackedGlance<Real> glance = visitor_->glance(
                PackedElements<Real>{grid_->rule(part.bisection), batch.level + part.depth,
                                     batch.keys[part.middle] + first, lo, hi});
            const auto bit = Bits::all(MaskOf<Real>{1} << i);
            descend = descend | (glance.descend & bit);
            stop = stop | (glance.stop & bit);
            greatest =
                max(greatest,
                    (glance.bound.template as<MaskOf<Real>>() & glance.stop).template as<Real>());
            glance.bound.store(batch.bounds[i + 2].data() + first);
        });
        descend.store(batch.entered.data() + first);
        stop.store(batch.stops.data() + first);
        greatest.store(batch.greatest_bounds.data() + first);
    }
}

/// Blocks in which nothing is entered beyond the ends.
/// \param are_leaves the ends
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::extract_blocks(Queue& batch,
                                                                       std::size_t first,
                                                                       std::size_t end,
                                                                       bool are_leaves) {
    BatchSelection selection;
    selection.ends_are_leaves = are_leaves;
    if (batch.stopped_before() >= end) {
        selection.add_blocks(first, end);
    } else {
        for (std::size_t b = first; b < end; ++b) {
            take_stopped(batch, b,
                         [&](const Stopped& element) { select(batch, element, selection); });
            selection.add_block(b);
        }
    }
    MaskOf<Real> stopped = 0;
    for (std::size_t b = first; b < end; ++b) stopped += count_bits(batch.stops[b]);
    count_->extracted += stopped;
    extract(batch, selection);
}

/// To be extracted next.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::select(Queue& batch, const Stopped& element,
                                                             BatchSelection& selection) {
    batch.template copy_element<in_subtrees_>(*element.of, element.block, element.part,
                                              element.bound);
    selection.add(room_ + batch.element_count++);
    ++count_->extracted;
    if (batch.element_count == room_) extract(batch, selection);
}

/// Those that stopped before the first block.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::extract_first_stopped(Queue& next) {
    BatchSelection selection;
    take_stopped(next, 0, [&](const Stopped& element) { select(next, element, selection); });
    if (selection.count > 0) extract(next, selection);
}

/// Blocks whose ends are split.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::enter(Queue& batch, std::size_t first,
                                                            std::size_t end, Queue& next) {
    Steps steps;
    list(batch, first, end, steps);
    look_at_ends(batch, steps);
    MaskOf<Real> any_entered = 0;
    for (std::size_t i = 0; i < steps.end.count; ++i) any_entered |= steps.descend[i];
    if (any_entered == 0) {
        finish(next);
        note_stopped_ends(batch, steps);
        return extract_blocks(batch, first, end, false);
    }
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
    std::size_t due = batch.stopped_before();
    // No branch here depends on what was seen: both are written, and counted where they are so.
    for (std::size_t i = 0; i < steps.count; ++i) {
        const std::size_t b = steps.block[i];
        const std::size_t part = steps.part[i];
        if (due <= b) {
            take_stopped(batch, b, put_stopped);
            due = batch.stopped_before();
        }
        if (next.count == room_) finish_next();
        const bool is_end = part >= ends_;
        const MaskOf<Real> ended = is_end ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        const MaskOf<Real> descends = steps.descend[next_end] & ended;
        const MaskOf<Real> stops = steps.stop[next_end] | ~ended;
        const Real* const bound = is_end ? &steps.bound[next_end] : &batch.bounds[part][b];
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
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::list(const Queue& batch, std::size_t first,
                                                           std::size_t end, Steps& steps) const {
    for (std::size_t b = first / pack * pack; b < end; b += pack) {
        unrolled<ends_>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const auto [lo, hi] = range_within<ends_ + i>(batch, b);
            lo.store(steps.least[i].data() + b);
            hi.store(steps.greatest[i].data() + b);
        });
    }
    for (std::size_t b = first; b < end; ++b) {
        steps.append(order_of(batch, b), b);
        steps.end.append(block_orders<pattern_>[static_cast<std::size_t>(batch.entered[b])], b);
    }
    for (std::size_t i = 0; i < steps.end.count; ++i) {
        const std::size_t b = steps.end.block[i];
        const std::size_t part = steps.end.part[i];
        const auto& parent = parent_of_new_[part];
        steps.lo[i] = steps.least[part - ends_][b];
        steps.hi[i] = steps.greatest[part - ends_][b];
        if constexpr (AnswersInRows<Grid>) {
            steps.from[i] = batch.nodes[parent[0]][b];
            steps.to[i] = batch.nodes[parent[1]][b];
        } else {
            steps.node[i] = grid_->middle_key(batch.keys[parent[0]][b], batch.keys[parent[1]][b]);
        }
    }
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_at_ends(const Batch& batch,
                                                                   Steps& steps) const {
    const std::size_t count = packed(steps.end.count);
    if (steps.end.count > 0) {
        if constexpr (AnswersInRows<Grid>) find_new_nodes(steps);
        const std::size_t last = steps.end.count - 1;
        for (std::size_t i = steps.end.count; i < count; ++i) {
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
    steps.descend[steps.end.count] = 0;
    steps.stop[steps.end.count] = 0;
    steps.bound[steps.end.count] = 0;
}

/// Of blocks whose ends all stop or are skipped.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::note_stopped_ends(Queue& batch, const Steps& steps) {
    for (std::size_t i = 0; i < steps.end.count; ++i) {
        if (steps.stop[i] == 0) continue;
        const std::size_t b = steps.end.block[i];
        const std::size_t part = steps.end.part[i];
        batch.stops[b] |= MaskOf<Real>{1} << (part - 2);
        batch.bounds[part][b] = steps.bound[i];
        batch.greatest_bounds[b] = std::max(batch.greatest_bounds[b], steps.bound[i]);
    }
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::copy_corners(const Batch& batch,
                                                                   Origins& which, Queue& next) {
    for (std::size_t n = which.copied; n < next.count; ++n) {
        const std::size_t b = which.block[n];
        const auto& part = pattern_.part[which.part[n]];
        unrolled<corners_>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const std::size_t from = Batch::Places::of(0, part.corner[i]) + b;
            next.nodes[i][n] = batch.nodes.all[from];
            next.keys[i][n] = batch.keys.all[from];
            next.values[i][n] = batch.values.all[from];
            if constexpr (in_subtrees_) next.in_subtree[i][n] = batch.in_subtree.all[from];
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
    if (next.stopped_before() == 0) extract_first_stopped(next);
    if (next.count > 0) walk(next);
    next.count = 0;
    next.stopped_count = 0;
    next.taken = 0;
}

}  // namespace nestgrid
