// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How PatchWalk goes down: from a batch of patches to the batches below it.
#pragma once

#include <patches/patch_walk_nodes.hpp>

namespace nestgrid::engine {

template <class Grid, class Field, class Visitor>
void PatchWalk<Grid, Field, Visitor>::run(const std::array<Node, 4>& n,
                                          const std::array<Real, 4>& u, int path) {
    constexpr KnownBisection rule = Grid::bisections[last_];
    // The number of levels of patches below the element, counted at its corner a. Subtrees begin so
    // far above the leaves that they end with these where all branches are as deep.
    int patches = 0;
    for (Node a = n[rule.parent[0]], b = n[rule.parent[1]]; grid_->halved(a, b); ++patches) {
        b = grid_->middle(a, b);
    }
    const int above_subtree = std::max(0, patches - InSubtree::height);
    subtree_level_ = path / 2 + static_cast<int>(Grid::patch_height) * above_subtree;

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

/// Traverses the batch and all below it. Requires corner nodes, keys and values, and in_subtree
/// where the visitor names edges.
template <class Grid, class Field, class Visitor>
void PatchWalk<Grid, Field, Visitor>::walk(Queue& batch) {
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
    std::array<bool, room_> split;  // by patch: whether the grid splits its ends
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
            extract_patches(batch, first, end, true);
        }
    }
    take_stopped(batch, batch.count, [&](const Stopped& element) {
        if (put(element, next)) finish(next);
    });
    finish(next);
}

/// Begins a subtree with each patch of the batch.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void PatchWalk<Grid, Field, Visitor>::begin_subtrees(Batch& batch) {
    for (std::size_t i = 0; i < corners_; ++i) {
        SubtreeNode* const nodes = batch.in_subtree[i];
        for (std::size_t b = 0; b < batch.count; ++b) nodes[b] = InSubtree::corner(nodes[b], b, i);
    }
    visitor_->begin_subtrees(InSubtree::edge_numbers(batch.count));
}

/// Asks the visitor about parts of the eight patches from `first` on. Sets their masks, bounds and
/// greatest bounds.
/// \param keys row of the first new node of these parts
template <class Grid, class Field, class Visitor>
template <PatchParts which>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::look_at(Batch& batch, std::size_t first,
                                                              const NodeKey* keys,
                                                              Row<MaskOf<Real>>& descend,
                                                              Row<MaskOf<Real>>& stop,
                                                              Real* greatest) const {
    const PackedPatches<Real> patches{rules_.data(), batch.level, batch.values[0] + first,
                                      keys + first, batch.bounds[0].data() + first};
    const PackedSight<Real> seen = [&]() NESTGRID_INLINE_LAMBDA {
        if constexpr (requires { visitor_->template see<which>(patches); }) {
            return visitor_->template see<which>(patches);
        } else {
            return engine::see<pattern_, which>(patches, *visitor_);
        }
    }();
    seen.descend.store(descend.data() + first);
    seen.stop.store(stop.data() + first);
    seen.greatest.store(greatest + first);
}

/// Asks the visitor about the inner parts of all patches.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::look_within(Queue& batch) const {
    for (std::size_t first = 0; first < batch.count; first += pack) {
        look_at<PatchParts::inner>(batch, first, batch.keys[corners_ + 1], batch.entered,
                                   batch.stops, batch.greatest_bounds.data());
    }
}

/// Extracts patches first ... end - 1, with the stopped elements before them. Requires that the
/// walk enters none of their ends.
/// \param are_leaves whether the ends are leaves
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void PatchWalk<Grid, Field, Visitor>::extract_patches(Queue& batch,
                                                                        std::size_t first,
                                                                        std::size_t end,
                                                                        bool are_leaves) {
    BatchSelection selection;
    selection.ends_are_leaves = are_leaves;
    if (batch.stopped_before() >= end) {
        selection.add_patches(first, end);
    } else {
        for (std::size_t b = first; b < end; ++b) {
            take_stopped(batch, b,
                         [&](const Stopped& element) { select(batch, element, selection); });
            selection.add_patch(b);
        }
    }
    MaskOf<Real> stopped = 0;
    for (std::size_t b = first; b < end; ++b) stopped += count_bits(batch.stops[b]);
    count_->extracted += stopped;
    extract(batch, selection);
}

/// Copies a stopped element behind the single elements of the batch and selects it. Extracts the
/// selection where the batch has no room for another.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::select(Queue& batch, const Stopped& element,
                                                             BatchSelection& selection) {
    batch.template copy_element<in_subtrees_>(*element.of, element.patch, element.part,
                                              element.bound);
    selection.add(room_ + batch.element_count++);
    ++count_->extracted;
    if (batch.element_count == room_) extract(batch, selection);
}

/// Extracts the elements that stopped before the first patch.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void PatchWalk<Grid, Field, Visitor>::extract_first_stopped(Queue& next) {
    BatchSelection selection;
    take_stopped(next, 0, [&](const Stopped& element) { select(next, element, selection); });
    if (selection.count > 0) extract(next, selection);
}

/// Goes on below patches first ... end - 1: appends the ends that the walk enters, and the elements
/// that stop, to `next`, and finishes `next` whenever it is full. Requires that the ends are split.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::enter(Queue& batch, std::size_t first,
                                                            std::size_t end, Queue& next) {
    Ends ends;
    look_at_ends(batch, first, end, ends);
    MaskOf<Real> any_descends = 0;
    for (std::size_t b = first; b < end; ++b) {
        ends.descend[b] &= batch.ends[b];
        ends.stop[b] &= batch.ends[b];
        any_descends |= ends.descend[b];
    }
    if (any_descends == 0) {
        finish(next);
        note_stopped_ends(batch, first, end, ends);
        return extract_patches(batch, first, end, false);
    }
    Origins which;
    which.copied = next.count;
    const auto finish_next = [&] {
        const std::size_t more = next.count - std::min(next.count, room_);
        next.count -= more;
        copy_corners(batch, which, next);
        finish(next);
        std::copy_n(which.patch.begin() + room_, more, which.patch.begin());
        std::copy_n(which.part.begin() + room_, more, which.part.begin());
        next.count = more;
    };
    const auto put_stopped = [&](const Stopped& element) {
        if (put(element, next)) finish_next();
    };
    std::size_t due = batch.stopped_before();
    for (std::size_t b = first; b < end; ++b) {
        const auto descends = static_cast<std::size_t>(ends.descend[b]);
        if ((ends.stop[b] | batch.stops[b]) == 0 && due > b) {
            which.append(end_orders<pattern_>[descends], b, next.count);
            if (next.count > room_) finish_next();
            continue;
        }
        take_stopped(batch, b, put_stopped);
        due = batch.stopped_before();
        // No branch depends on the decisions: writes a part to both lists, and counts it in the one
        // to which it belongs.
        const std::size_t descend_by_part = descends << ends_;
        const std::size_t stop_by_part = static_cast<std::size_t>(ends.stop[b]) << ends_ |
                                         static_cast<std::size_t>(batch.stops[b]) << 2U;
        const PatchOrder<ends_>& order = order_of(batch, b);
        for (std::size_t i = 0; i < order.count; ++i) {
            const std::size_t part = order.part[i];
            if (next.count == room_) finish_next();
            which.patch[next.count] = static_cast<std::uint8_t>(b);
            which.part[next.count] = static_cast<std::uint8_t>(part);
            next.stopped[next.stopped_count] = {
                &batch, static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(part),
                static_cast<std::uint8_t>(next.count), batch.bounds[part][b]};
            next.count += descend_by_part >> part & 1U;
            next.stopped_count += stop_by_part >> part & 1U;
            if (next.stopped_count == stopped_room_) finish_next();
        }
    }
    take_stopped(batch, end - 1, put_stopped);
    copy_corners(batch, which, next);
}

/// Asks the visitor about the ends of patches first ... end - 1. Does not ask about eight patches
/// of which the walk reaches no end.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::look_at_ends(Queue& batch, std::size_t first,
                                                                   std::size_t end,
                                                                   Ends& ends) const {
    const auto reached = [&](std::size_t b) {
        return b < end && std::any_of(batch.ends.begin() + std::max(b, first),
                                      batch.ends.begin() + std::min(b + pack, end),
                                      [](std::uint8_t set) { return set != 0; });
    };
    for (std::size_t b = first / pack * pack; b < end;) {
        if (!reached(b)) {
            Pack<MaskOf<Real>>::all(0).store(ends.descend.data() + b);
            Pack<MaskOf<Real>>::all(0).store(ends.stop.data() + b);
            b += pack;
            continue;
        }
        std::size_t next = b + pack;
        while (reached(next)) next += pack;
        find_new_nodes(batch, std::max(b, first), std::min(next, end), ends);
        for (; b < next; b += pack) {
            look_at<PatchParts::ends>(batch, b, ends.keys[0].data(), ends.descend, ends.stop,
                                      ends.greatest.data());
        }
    }
}

/// Adds the ends that stop to the parts that stop. Requires that the walk enters no end of patches
/// first ... end - 1.
template <class Grid, class Field, class Visitor>
void PatchWalk<Grid, Field, Visitor>::note_stopped_ends(Queue& batch, std::size_t first,
                                                        std::size_t end, const Ends& ends) {
    for (std::size_t b = first; b < end; ++b) {
        if (ends.stop[b] == 0) continue;
        batch.stops[b] |= ends.stop[b] << (ends_ - 2);
        batch.greatest_bounds[b] = std::max(batch.greatest_bounds[b], ends.greatest[b]);
    }
}

/// Copies the corners of the next patches from the batch.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void PatchWalk<Grid, Field, Visitor>::copy_corners(const Batch& batch,
                                                                   Origins& which, Queue& next) {
    for (std::size_t n = which.copied; n < next.count; ++n) {
        const std::size_t b = which.patch[n];
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
bool PatchWalk<Grid, Field, Visitor>::put(const Stopped& element, Queue& next) {
    Stopped& last = next.stopped[next.stopped_count++];
    last = element;
    last.before = static_cast<std::uint8_t>(next.count);
    return next.stopped_count == stopped_room_;
}

/// Walks the queue and all below it, and empties it.
template <class Grid, class Field, class Visitor>
void PatchWalk<Grid, Field, Visitor>::finish(Queue& next) {
    if (next.stopped_before() == 0) extract_first_stopped(next);
    if (next.count > 0) walk(next);
    next.count = 0;
    next.stopped_count = 0;
    next.taken = 0;
}

}  // namespace nestgrid::engine
