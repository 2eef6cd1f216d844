// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The traversal of patches of bisections, many of one level at a time: what memory holds of all of
// them is asked for at once, and nothing waits for what is said of another.
//
// Invariant: elements are extracted in the order of the plain traversal. A batch is a run of that
// order, walked to its end before the next one begins; elements that stop travel down with the
// patches before them, until all of those are done.
// Memory: one batch a level of patches, on the stack: about 25 KB with single precision.
#pragma once

#include <cstring>

#include <patches/patch_batch.hpp>

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

/// Walks down from an element that starts a patch and in which all is whole. A visitor has
///     PackedGlance glance(const PackedElements&) what to do with each of them; or instead
///     PackedSight see<PatchParts>(const PackedPatches&)
///                                                of many elements at once
///     void expect(const NodeKey* nodes, std::size_t rows)
///                                                optional: eight nodes in each of some rows,
///                                                most_patches apart, that will be glanced at
///     unsigned extract(const PatchBatch&, const BatchSelection&)
///             what is selected, and in how many of the leaves there was anything to extract
///     bool names_edges() const                   optional, with the next one: whether batches are
///                                                to tell of nodes in subtrees (subtree_nodes.hpp)
///     void begin_subtrees(std::uint32_t numbers) edges will have numbers below; what was inside
///                                                subtrees before comes never again
///     void tick(looked_at, visited)              now and then
template <class Grid, class Field, class Visitor>
class PatchWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;

    PatchWalk(const Grid& grid, const Field& field, Visitor& visitor, WalkCounts& count)
        : grid_{&grid}, field_{&field}, visitor_{&visitor}, count_{&count} {
        for (std::size_t i = 0; i < rules_.size(); ++i) rules_[i] = &grid.rule(i);
    }

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
    static constexpr unsigned interior_ = (1U << (ends_ - 2)) - 1;  // parts that are no ends

    /// An element that is extracted when the patches before it are done.
    struct Stopped {
        const Batch* of;
        std::uint8_t patch;
        std::uint8_t part;
        std::uint8_t before;  // how many patches
        Real bound;
    };
    /// A run of the order of the traversal.
    struct Queue : Batch {
        Row<MaskOf<Real>> entered;  // parts of patches, from bit 0 on part 2
        std::array<Stopped, stopped_room_ + 1> stopped;
        std::size_t stopped_count = 0;
        std::size_t taken = 0;  // of them

        /// The patch that the next of them comes before, if any.
        std::size_t stopped_before() const {
            return taken < stopped_count ? stopped[taken].before : ~std::size_t{0};
        }
    };
    /// What there is to know of the ends of patches, reached or not.
    struct Ends {
        Row<MaskOf<Real>> descend;  // bit i: end i
        Row<MaskOf<Real>> stop;
        std::array<Row<NodeKey>, pattern_.all_nodes - pattern_.nodes> keys;  // of new nodes
        Row<Real> greatest;
    };

    /// The parts of a batch that the patches of the next one are.
    struct Origins {
        std::array<std::uint8_t, room_ + ends_> patch;
        std::array<std::uint8_t, room_ + ends_> part;
        std::size_t copied;  // patches before this one are

        /// Those of patch b. Nothing depends on how many they are.
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
    void make_nodes(Batch& batch) const;
    void ask_for_nodes(Batch& batch) const;
    NESTGRID_INLINE void expect(const NodeKey* keys, std::size_t rows = 1) const {
        if constexpr (requires { visitor_->expect(keys, rows); }) visitor_->expect(keys, rows);
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
    static const auto& order_of(const Queue& batch, std::size_t b) {
        return patch_orders<pattern_>[static_cast<std::size_t>(batch.entered[b] |
                                                               batch.stops[b] << (ends_ - 2))];
    }
    /// \return whether there is no room for another
    static bool put(const Stopped& element, Queue& next);
    void extract(Queue& batch, BatchSelection& selection) {
        if (batch.element_count > 0) batch.fill_up_elements();
        count_->extracted +=
            visitor_->extract(std::as_const(static_cast<Batch&>(batch)), selection);
        batch.element_count = 0;
        selection.clear();
    }
    void select(Queue& batch, const Stopped& element, BatchSelection& selection);
    void extract_first_stopped(Queue& next);
    /// Calls function(const Stopped&) for those up to a patch that were not taken yet.
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
    int subtree_level_ = 0;  // on which subtrees start
};

}  // namespace nestgrid

#include <patches/patch_walk_nodes.hpp>
#include <patches/patch_walk_steps.hpp>
