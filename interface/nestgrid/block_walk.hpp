// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The traversal of blocks of bisections, many of one level at a time: what memory holds of all of
// them is asked for at once, and nothing waits for what is said of another.
//
// Invariant: elements are extracted in the order of the plain traversal. A batch is a run of that
// order, walked to its end before the next one begins; elements that stop travel down with the
// blocks before them, until all of those are done.
// Memory: one batch a level of blocks, on the stack.
#pragma once

#include <cstring>

#include <nestgrid/block_batch.hpp>

namespace nestgrid {

struct WalkCounts {
    std::uint64_t bisected = 0;
    std::uint64_t extracted = 0;
    std::uint64_t masked = 0;

    std::uint64_t looked_at() const { return 1 + 2 * bisected - masked; }  ///< elements
    std::uint64_t visited() const { return bisected + extracted; }         ///< of interest

    template <class Visitor>
    void bisect(std::uint64_t more, Visitor& visitor) {
        bisected += more;
        if (bisected < next_tick_) return;
        next_tick_ = bisected + 0x4000U;
        visitor.tick(looked_at(), visited());
    }

private:
    std::uint64_t next_tick_ = 0x4000U;
};

/// Walks down from an element that starts a block. A visitor has
///     PackedGlance glance(const PackedElements&) what to do with each of them
///     bool glance_at_leaf(Real lo, Real hi)      whether to extract it
///     void extract_part(const BlockBatch&, std::size_t b, std::size_t part, Real bound)
///             an element of block b; bound: what glance() said of it, or 0 for a leaf
///     unsigned extract_blocks(const BlockBatch&, std::size_t first, std::size_t end,
///                             const std::uint8_t* entered)
///             of blocks first ... end - 1 those of the ends entered of which glance_at_leaf() says
///             so, and says how many; bit i of entered[b] stands for end i. All ends are leaves
///     void begin_subtrees()                      optional, to be told of faces: what was inside
///                                                subtrees before comes never again
///     void tick(looked_at, visited)              now and then
template <class Grid, class Field, class Visitor>
class BlockWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;

    BlockWalk(const Grid& grid, const Field& field, Visitor& visitor, WalkCounts& count)
        : grid_{&grid}, field_{&field}, visitor_{&visitor}, count_{&count} {}

    /// \param path twice the level, plus 1 where the orientation is negative
    NESTGRID_NOINLINE void run(const std::array<Node, 4>& n, const std::array<Real, 4>& u,
                               int path);

private:
    static constexpr const auto& pattern_ = block_of<Grid>;
    static constexpr std::size_t corners_ = pattern_.corners;
    static constexpr std::size_t ends_ = pattern_.ends;
    static constexpr std::size_t last_ = Grid::bisections.size() - 1;
    static_assert(pattern_.part[1].middle == corners_);
    static_assert(std::ranges::all_of(pattern_.part.begin() + ends_, pattern_.part.end(),
                                      [](const auto& end) { return end.bisection == last_; }));
    /// The nodes between which the new node of a part lies.
    static constexpr auto parent_of_new_ = [] {
        std::array<std::array<std::uint8_t, 2>, 2 * ends_> result{};
        for (std::size_t p = 1; p < 2 * ends_; ++p) {
            const auto& part = pattern_.part[p];
            for (std::size_t i = 0; i < 2; ++i) {
                result[p][i] = part.corner[Grid::bisections[part.bisection].parent[i]];
            }
        }
        return result;
    }();
    static constexpr bool in_subtrees_ = requires(Visitor & v) { v.begin_subtrees(); };
    /// Three blocks of tetrahedra: 512 leaves, of whose edges half lie inside.
    static constexpr int subtree_height_ = 3;
    static constexpr std::size_t room_ = most_blocks;
    static constexpr std::size_t stopped_room_ = 64;
    using Batch = BlockBatch<Grid, Real, room_>;
    template <class T>
    using Row = typename Batch::template Row<T>;

    /// An element that is extracted when the blocks before it are done.
    struct Stopped {
        const Batch* of;
        std::uint8_t block;
        std::uint8_t part;
        std::uint8_t before;  // how many blocks
        Real bound;
    };
    /// A run of the order of the traversal.
    struct Queue : Batch {
        std::array<Stopped, stopped_room_ + 1> stopped;
        std::size_t stopped_count = 0;
        std::size_t taken = 0;  // of them
    };
    /// What becomes of the elements within blocks, ends excepted.
    struct Interior {
        Row<MaskOf<Real>> descend;  // bit i: part i + 2
        Row<MaskOf<Real>> stop;
        std::array<Row<Real>, ends_> bound;  // by part
    };
    /// Parts of blocks in the order of the traversal: ends, which are split, and what stops.
    struct Steps {
        static constexpr std::size_t room = room_ * ends_;
        std::size_t count = 0;
        std::array<std::uint8_t, room + ends_> block;
        std::array<std::uint8_t, room + ends_> part;
        // Of the ends alone:
        std::size_t end_count = 0;
        alignas(64) std::array<Real, room + 1> lo;
        alignas(64) std::array<Real, room + 1> hi;
        alignas(64) std::array<NodeKey, room + 1> node;
        alignas(64) std::array<MaskOf<Real>, room + 1> descend;
        alignas(64) std::array<MaskOf<Real>, room + 1> stop;
        alignas(64) std::array<Real, room + 1> bound;
    };

    NESTGRID_NOINLINE void walk(Queue& batch);
    void begin_subtrees(Batch& batch);
    void make_nodes(Batch& batch) const;
    void look_within(const Batch& batch, Interior& interior) const;
    bool has_leaves(const Batch& batch, std::size_t b) const {
        constexpr auto first = pattern_.part[ends_];
        constexpr KnownBisection next = Grid::bisections[first.bisection];
        return !grid_->halved(batch.nodes[first.corner[next.parent[0]]][b],
                              batch.nodes[first.corner[next.parent[1]]][b]);
    }
    void extract_leaves(Queue& batch, const Interior& interior, std::size_t first,
                        std::size_t end);
    void extract_some_leaves(const Batch& batch, const Interior& interior, std::size_t b);
    void enter(Queue& batch, const Interior& interior, std::size_t first, std::size_t end,
               Queue& next);
    void list(const Batch& batch, const Interior& interior, std::size_t first, std::size_t end,
              Steps& steps) const;
    void look_at_ends(const Batch& batch, Steps& steps) const;
    static void copy_corners(const Batch& batch, std::size_t b, std::size_t part, Queue& next);
    static const auto& order_of(const Interior& interior, std::size_t b) {
        return block_orders<pattern_>[static_cast<std::size_t>(
            interior.descend[b] | interior.stop[b] << (ends_ - 2))];
    }
    NESTGRID_INLINE static std::pair<Real, Real> range_within(const Batch& batch, std::size_t b,
                                                              std::size_t part) {
        const auto& corner = pattern_.part[part].corner;
        return range_of<Real>({batch.value(b, corner[0]), batch.value(b, corner[1]),
                               batch.value(b, corner[2]), batch.value(b, corner[3])});
    }
    void put(const Stopped& element, Queue& next);
    void extract(const Batch& batch, std::size_t b, std::size_t part, Real bound) {
        ++count_->extracted;
        visitor_->extract_part(batch, b, part, bound);
    }
    void extract(const Stopped& element) {
        extract(*element.of, element.block, element.part, element.bound);
    }
    /// Calls function(const Stopped&) for those before a block.
    template <class Function>
    static void take_stopped(Queue& batch, std::size_t before, Function&& function) {
        while (batch.taken < batch.stopped_count && batch.stopped[batch.taken].before == before) {
            function(batch.stopped[batch.taken++]);
        }
    }
    void finish(Queue& next);

    const Grid* grid_;
    const Field* field_;
    Visitor* visitor_;
    WalkCounts* count_;
    int subtree_level_ = 0;  // on which subtrees start
};

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
    first.count = 1;
    const auto [lo, hi] = range_of(u);
    const NodeKey middle =
        grid_->middle_key(first.keys[rule.parent[0]][0], first.keys[rule.parent[1]][0]);
    const auto [visit, bound] = visitor_->glance(lo, hi, grid_->rule(last_), middle, path / 2, false);
    if (visit == Visit::stop) extract(first, 0, 1, bound);
    if (visit == Visit::descend) walk(first);
}

/// The blocks of a batch, of which there are the corners, and all below them.
template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::walk(Queue& batch) {
    if constexpr (in_subtrees_) {
        if (batch.level == subtree_level_) begin_subtrees(batch);
    }
    batch.fill_up();
    make_nodes(batch);
    Interior interior;
    look_within(batch, interior);
    std::uint64_t descended = batch.count;
    std::array<bool, room_ + 1> leaves;
    for (std::size_t b = 0; b < batch.count; ++b) {
        const auto& reached = pattern_.reached[static_cast<std::size_t>(interior.descend[b])];
        interior.descend[b] &= reached.interior;
        interior.stop[b] &= reached.interior;
        descended += reached.descended;
        leaves[b] = has_leaves(batch, b);
    }
    count_->bisect(descended, *visitor_);

    Queue next;
    next.begin(*grid_, last_, batch.level + static_cast<int>(pattern_.height));
    for (std::size_t first = 0, end = 0; first < batch.count; first = end) {
        while (end < batch.count && leaves[end] == leaves[first]) ++end;
        if (leaves[first]) {
            finish(next);
            extract_leaves(batch, interior, first, end);
        } else {
            enter(batch, interior, first, end, next);
        }
    }
    take_stopped(batch, batch.count, [&](const Stopped& element) { put(element, next); });
    finish(next);
}

template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::begin_subtrees(Batch& batch) {
    for (std::size_t i = 0; i < corners_; ++i) {
        batch.sides[i].fill(static_cast<SubtreeFaces>((1U << corners_) - 1 - (1U << i)));
    }
    visitor_->begin_subtrees();
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
        const auto& [from, to] = pattern_.parent[at];
        const auto halve = [&](auto& rows, auto&& middle) NESTGRID_INLINE_LAMBDA {
            using T = std::remove_reference_t<decltype(rows[0][0])>;
            if constexpr (requires(Pack<T> a) { middle(a, a); }) {
                middle(Pack<T>::load(rows[from].data() + first),
                       Pack<T>::load(rows[to].data() + first))
                    .store(rows[at].data() + first);
            } else {
                for (std::size_t b = first; b < first + pack; ++b) {
                    rows[at][b] = middle(rows[from][b], rows[to][b]);
                }
            }
        };
        halve(batch.nodes, [&](const auto& a, const auto& b) NESTGRID_INLINE_LAMBDA
                  requires requires { grid_->middle(a, b); } { return grid_->middle(a, b); });
        halve(batch.keys, [&](const auto& a, const auto& b) NESTGRID_INLINE_LAMBDA
                  requires requires { grid_->middle_key(a, b); }
              { return grid_->middle_key(a, b); });
        if constexpr (requires { visitor_->expect(NodeKey{}); }) {
            for (std::size_t b = first; b < first + pack; ++b) visitor_->expect(batch.keys[at][b]);
        }
        if constexpr (in_subtrees_) {
            for (std::size_t b = first; b < first + pack; ++b) {
                batch.sides[at][b] = batch.sides[from][b] & batch.sides[to][b];
            }
        }
    });
    each_new_node([&](auto at, std::size_t first) NESTGRID_INLINE_LAMBDA {
        Pack<Real>::make([&](auto b) NESTGRID_INLINE_LAMBDA {
            return field_->template value_at<true>(batch.nodes[at][first + b],
                                                   batch.keys[at][first + b]);
        }).store(batch.values[at].data() + first);
    });
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
            const PackedGlance<Real> glance = visitor_->glance(PackedElements<Real>{
                grid_->rule(part.bisection), batch.level + part.depth,
                batch.keys[part.middle].data() + first, min(min(u0, u1), min(u2, u3)),
                max(max(u0, u1), max(u2, u3))});
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
    const auto extract_until = [&](std::size_t b) {
        if (first == b) return;
        count_->extracted += visitor_->extract_blocks(batch, first, b, entered.data());
        first = b;
    };
    for (std::size_t b = first; b < end; ++b) {
        if (batch.taken < batch.stopped_count && batch.stopped[batch.taken].before == b) {
            extract_until(b);
            take_stopped(batch, b, [&](const Stopped& element) { extract(element); });
        }
        if (interior.stop[b] != 0) {
            extract_until(b);
            extract_some_leaves(batch, interior, b);
            first = b + 1;
        }
    }
    extract_until(end);
}

/// A block of leaves in which something stops.
template <class Grid, class Field, class Visitor>
NESTGRID_NOINLINE void BlockWalk<Grid, Field, Visitor>::extract_some_leaves(
    const Batch& batch, const Interior& interior, std::size_t b) {
    const auto& list = order_of(interior, b);
    for (std::size_t i = 0; i < list.count; ++i) {
        const std::size_t part = list.part[i];
        if (part < ends_) {
            extract(batch, b, part, interior.bound[part][b]);
            continue;
        }
        const auto [lo, hi] = range_within(batch, b, part);
        if (visitor_->glance_at_leaf(lo, hi)) extract(batch, b, part, Real(0));
    }
}

/// Blocks whose ends are split.
template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::enter(Queue& batch, const Interior& interior,
                                                            std::size_t first, std::size_t end,
                                                            Queue& next) {
    Steps steps;
    list(batch, interior, first, end, steps);
    look_at_ends(batch, steps);
    std::size_t block = first;
    std::size_t next_end = 0;
    // Without branches that depend on what was seen: what might be needed is written, and counted
    // where it is.
    for (std::size_t i = 0; i < steps.count; ++i) {
        const std::size_t b = steps.block[i];
        const std::size_t part = steps.part[i];
        if (batch.taken < batch.stopped_count) {
            for (; block <= b; ++block) {
                take_stopped(batch, block, [&](const Stopped& element) { put(element, next); });
            }
        }
        if (next.count == room_) finish(next);
        const bool is_end = part >= ends_;
        const MaskOf<Real> ended = is_end ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        const MaskOf<Real> descends = steps.descend[next_end] & ended;
        const MaskOf<Real> stops = steps.stop[next_end] | ~ended;
        const Real* const bound = is_end ? &steps.bound[next_end] : &interior.bound[part % ends_][b];
        next_end += is_end ? 1 : 0;
        copy_corners(batch, b, part, next);
        next.stopped[next.stopped_count] = {&batch, static_cast<std::uint8_t>(b),
                                            static_cast<std::uint8_t>(part),
                                            static_cast<std::uint8_t>(next.count), *bound};
        next.count += descends & 1U;
        next.stopped_count += stops & 1U;
        if (next.stopped_count == stopped_room_) finish(next);
    }
    if (batch.taken < batch.stopped_count) {
        for (; block < end; ++block) {
            take_stopped(batch, block, [&](const Stopped& element) { put(element, next); });
        }
    }
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::list(const Batch& batch,
                                                           const Interior& interior,
                                                           std::size_t first, std::size_t end,
                                                           Steps& steps) const {
    for (std::size_t b = first; b < end; ++b) {
        const auto& order = order_of(interior, b);
        std::memcpy(steps.part.data() + steps.count, order.part.data(), ends_);
        std::memset(steps.block.data() + steps.count, static_cast<int>(b), ends_);
        steps.count += order.count;
    }
    for (std::size_t i = 0; i < steps.count; ++i) {
        const std::size_t b = steps.block[i];
        const std::size_t part = steps.part[i];
        const auto [lo, hi] = range_within(batch, b, part);
        const auto& parent = parent_of_new_[part];
        steps.lo[steps.end_count] = lo;
        steps.hi[steps.end_count] = hi;
        steps.node[steps.end_count] =
            grid_->middle_key(batch.key(b, parent[0]), batch.key(b, parent[1]));
        steps.end_count += part >= ends_ ? 1 : 0;
    }
}

template <class Grid, class Field, class Visitor>
NESTGRID_INLINE void BlockWalk<Grid, Field, Visitor>::look_at_ends(const Batch& batch,
                                                                   Steps& steps) const {
    const std::size_t count = packed(steps.end_count);
    if (steps.end_count > 0) {
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
                                                                   std::size_t b, std::size_t part,
                                                                   Queue& next) {
    const auto& which = pattern_.part[part];
    const std::size_t n = next.count;
    const Node* const nodes = batch.nodes[0].data() + b;
    const NodeKey* const keys = batch.keys[0].data() + b;
    const Real* const values = batch.values[0].data() + b;
    unrolled<corners_>([&](auto i) NESTGRID_INLINE_LAMBDA {
        const std::size_t from = room_ * which.corner[i];
        next.nodes[i][n] = nodes[from];
        next.keys[i][n] = keys[from];
        next.values[i][n] = values[from];
        if constexpr (in_subtrees_) next.sides[i][n] = batch.sides[which.corner[i]][b];
    });
    next.orientations[n] =
        static_cast<std::uint8_t>(batch.orientations[b] ^ (which.mirrored ? 1U : 0U));
}

template <class Grid, class Field, class Visitor>
void BlockWalk<Grid, Field, Visitor>::put(const Stopped& element, Queue& next) {
    Stopped& last = next.stopped[next.stopped_count++];
    last = element;
    last.before = static_cast<std::uint8_t>(next.count);
    if (next.stopped_count == stopped_room_) finish(next);
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
