// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Traverses patches of bisections, a batch of one level at a time (patch_batch.hpp): the walk
// fetches what it needs of all patches of a batch at once, so that no patch waits for the answer
// about another one.
//
// Invariant: the walk extracts elements in the order of the plain traversal. A batch is a run of
// that order, and the walk finishes what is below a batch before it begins the next one. An element
// that stops travels down with the patches before it, until the walk has finished these.
// Memory: one batch for each level of patches, on the stack: about 25 KB in single precision.
// The members are defined in patch_descent.hpp and patch_walk_nodes.hpp.
#pragma once

#include <cstring>

#include <patches/mean_values.hpp>
#include <patches/patch_batch.hpp>

namespace nestgrid::engine {

/// Counts the elements of a walk.
struct WalkCounts {
    std::uint64_t bisected = 0;   ///< elements that the walk entered
    std::uint64_t extracted = 0;  ///< elements that it extracted
    std::uint64_t masked = 0;     ///< masked children, which it left out

    /// Elements that a visitor decided about.
    std::uint64_t looked_at() const { return 1 + 2 * bisected - masked; }
    /// Elements of interest to it.
    std::uint64_t visited() const { return bisected + extracted; }

    /// Counts elements that the walk enters, and reports the counts now and then.
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

/// Walks down from an element that begins a patch. Requires that the element is whole
/// (known_bisection.hpp). Beside glance() for single elements (BisectionWalk), a visitor has
///     PackedGlance glance(const PackedElements&) decides about eight elements at once; or instead
///     PackedSight see<PatchParts>(const PackedPatches&)
///                                             decides about parts of eight patches at once
///     void prefetch(const NodeKey* nodes, std::size_t rows)
///                                             optional: the walk will ask about eight nodes in
///                                             each of these rows, most_patches apart
///     unsigned extract(const PatchBatch&, const BatchSelection&)
///                                             extracts the selection; returns the number of ends
///                                             among it with anything to extract
///     bool names_edges() const                optional, with begin_subtrees(): whether the walk
///                                             shall set PatchBatch::in_subtree
///     void begin_subtrees(std::uint32_t numbers) new subtrees begin (subtree_nodes.hpp): all edges
///                                             have smaller numbers from now on, and edges inside
///                                             earlier subtrees do not come again
///     void tick(looked_at, visited)           called now and then with the counts so far
template <class Grid, class Field, class Visitor>
class PatchWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;

    PatchWalk(const Grid& grid, const Field& field, Visitor& visitor, WalkCounts& count)
        : grid_{&grid}, field_{&field}, visitor_{&visitor}, count_{&count} {
        for (std::size_t i = 0; i < rules_.size(); ++i) rules_[i] = &grid.rule(i);
    }

    /// Walks an element and all below it.
    /// \param n, u corners, and values at them
    /// \param path twice the level, plus 1 where the orientation is negative
    NESTGRID_NOINLINE void run(const std::array<Node, 4>& n, const std::array<Real, 4>& u,
                               int path);

private:
    static constexpr const auto& pattern_ = patch_of<Grid>;
    static constexpr std::size_t corners_ = pattern_.corners;
    static constexpr std::size_t ends_ = pattern_.ends;
    static constexpr std::size_t last_ = Grid::bisections.size() - 1;
    static_assert(pattern_.part[1].middle == corners_);
    static_assert(std::ranges::all_of(pattern_.part.begin() + ends_, pattern_.part.end(),
                                      [](const auto& end) { return end.bisection == last_; }));
    static constexpr bool in_subtrees_ = requires(Visitor & v) { v.begin_subtrees(1); };
    using InSubtree = SubtreeNodes<pattern_>;
    static constexpr std::size_t room_ = most_patches;
    static constexpr std::size_t stopped_room_ = 64;
    using Batch = PatchBatch<Grid, Real>;
    template <class T>
    using Row = typename Batch::template Row<T>;
    static constexpr unsigned interior_ = (1U << (ends_ - 2)) - 1;  // the set of all inner parts

    /// A part of a patch that stopped. The walk extracts it after the patches before it.
    struct Stopped {
        const Batch* of;  // the batch of its patch
        std::uint8_t patch;
        std::uint8_t part;
        std::uint8_t before;  // number of patches before it in the queue that holds it
        Real bound;
    };
    /// A run of the order of the traversal: a batch, and stopped elements between its patches.
    struct Queue : Batch {
        Row<MaskOf<Real>> entered;  // by patch: set of inner parts to enter
        std::array<Stopped, stopped_room_ + 1> stopped;
        std::size_t stopped_count = 0;
        std::size_t taken = 0;  // number of stopped elements that were taken out

        /// The patch before which the next stopped element comes; if there is none, a greater
        /// number than any patch has.
        std::size_t stopped_before() const {
            return taken < stopped_count ? stopped[taken].before : ~std::size_t{0};
        }
    };
    /// The visitor's decisions about the ends of patches, reached or not.
    struct Ends {
        Row<MaskOf<Real>> descend;  // by patch, a set of ends
        Row<MaskOf<Real>> stop;
        // Keys of the new nodes of ends.
        std::array<Row<NodeKey>, pattern_.all_nodes - pattern_.nodes> keys;
        Row<Real> greatest;  // by patch: at least the bound of each end that stops
    };

    /// By patch of the next batch: the patch and the part of this batch that it begins with.
    struct Origins {
        std::array<std::uint8_t, room_ + ends_> patch;
        std::array<std::uint8_t, room_ + ends_> part;
        std::size_t copied;  // patches before this one have their corners

        /// Appends parts of patch b. Writes as many bytes however many parts there are.
        NESTGRID_INLINE void append(const PatchOrder<ends_>& order, std::size_t b,
                                    std::size_t& count) {
            std::memcpy(part.data() + count, order.part.data(), ends_);
            std::memset(patch.data() + count, static_cast<int>(b), ends_);
            count += order.count;
        }
    };

    NESTGRID_NOINLINE void walk(Queue& batch);
    void begin_subtrees(Batch& batch);
    void number_nodes(Batch& batch) const;
    template <class T, class Middle>
    static void halve(const T* from, const T* to, T* middles, std::size_t first, std::size_t end,
                      const Middle& middle);
    void halve_keys(const Batch& batch, std::size_t node, std::size_t first, std::size_t end,
                    NodeKey* middles) const;
    void halve_values(Batch& batch, std::size_t node, std::size_t first, std::size_t end) const;
    void make_nodes(Batch& batch) const;
    void ask_for_nodes(Batch& batch) const;
    NESTGRID_INLINE void prefetch(const NodeKey* keys, std::size_t rows = 1) const {
        if constexpr (requires { visitor_->prefetch(keys, rows); }) visitor_->prefetch(keys, rows);
    }
    template <PatchParts which>
    void look_at(Batch& batch, std::size_t first, const NodeKey* keys, Row<MaskOf<Real>>& descend,
                 Row<MaskOf<Real>>& stop, Real* greatest) const;
    void look_within(Queue& batch) const;
    void look_whether_split(const Batch& batch, std::array<bool, room_>& ends) const;
    void extract_patches(Queue& batch, std::size_t first, std::size_t end, bool are_leaves);
    void enter(Queue& batch, std::size_t first, std::size_t end, Queue& next);
    void look_at_ends(Queue& batch, std::size_t first, std::size_t end, Ends& ends) const;
    void find_new_nodes(const Batch& batch, std::size_t first, std::size_t end, Ends& ends) const;
    static void note_stopped_ends(Queue& batch, std::size_t first, std::size_t end,
                                  const Ends& ends);
    static void copy_corners(const Batch& batch, Origins& which, Queue& next);
    /// The parts of patch b that stop and the ends that are reached, in order.
    static const auto& order_of(const Queue& batch, std::size_t b) {
        return patch_orders<pattern_>[static_cast<std::size_t>(batch.entered[b] |
                                                               batch.stops[b] << (ends_ - 2))];
    }
    /// Appends a stopped element to a queue. \return whether the queue is full then
    static bool put(const Stopped& element, Queue& next);
    /// Lets the visitor extract a selection, and empties it and the list of single elements.
    void extract(Queue& batch, BatchSelection& selection) {
        if (batch.element_count > 0) batch.fill_up_elements();
        count_->extracted +=
            visitor_->extract(std::as_const(static_cast<Batch&>(batch)), selection);
        batch.element_count = 0;
        selection.clear();
    }
    void select(Queue& batch, const Stopped& element, BatchSelection& selection);
    void extract_first_stopped(Queue& next);
    /// Takes the stopped elements before a patch out of a queue, and calls function(const Stopped&)
    /// for each.
    template <class Function>
    static void take_stopped(Queue& batch, std::size_t patch, Function&& function) {
        while (batch.stopped_before() <= patch) {
            function(batch.stopped[batch.taken++]);
        }
    }
    void finish(Queue& next);

    const Grid* grid_;
    const Field* field_;
    Visitor* visitor_;
    WalkCounts* count_;
    std::array<const Rule*, last_ + 1> rules_;
    int subtree_level_ = 0;  // the level on which subtrees begin
};

}  // namespace nestgrid::engine
