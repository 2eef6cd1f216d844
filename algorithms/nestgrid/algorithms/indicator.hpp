// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The hierarchical indicator and its saturated preroll (paper, sections 2 and 4.4).
//
// Two numbers per node, both from the offsets |U_delta| = |U - sum omega U|:
//   stop   the largest offset of the node and of all nodes created, at any depth, in elements it is
//          a corner of (section 2): S(x) = (stop(x) <= epsilon) is a saturated criterion;
//   bound  the recursive sum of section 4.4, |U_delta(x)| + max over finer nodes: on an element,
//          U stays within corner values +- the largest bound of its new nodes.
// The first is not a valid bound: offsets of several levels add up.
// Invariants, after construction:
//   - stop(corner) >= stop(new node) for every split element;
//   - bound(corner) >= |U_delta(corner)| + bound(new node), for every split element, corners that
//     are themselves new nodes of something;
//   - both also for a parent of a new node that is a new node of the same split;
//   - stop and bound of a new node inside the element are not below those of all its new nodes, so
//     that one look tells.
// A solver's own error indicator, one number per leaf, may take the place of the offsets in `stop`:
// that of a node is then the largest of the leaves around it, saturated likewise. Bounds always
// come from the data. Both are rounded up to bfloat16, every sum at once, so that the invariants
// hold exactly for the numbers that are kept.
// Memory: O(nodes), 4 bytes (plus 16 to 48 for a hash table where node keys are not dense); while
// it is built nothing more where the grid knows stars, else 12, and 4 for each node of each split.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/indicator_walk.hpp>
#include <nestgrid/algorithms/round_up.hpp>
#include <nestgrid/derive_hanging.hpp>

namespace nestgrid {

class HierarchicalIndicator {
public:
    static constexpr bool saturated = true;

    /// Walks the whole hierarchy; component 0 of the field counts.
    /// \throw InvalidInput where a value is not a number, infinite, or beyond a quarter of the
    ///        range of its type
    /// \param leaf_error errors of leaves in the place of offsets, such as a Kelly or residual
    ///        estimate; then thresholds have their unit. Called as double(const Element&) for every
    ///        leaf; not negative
    /// \param executor of several threads, all of which call leaf_error, or of one (executor.hpp);
    ///        the result does not depend on it
    /// \throw InvalidInput also where an error is negative or not a number
    template <class Grid, class Field, class LeafError, Executor E = SequentialExecutor>
        requires(std::is_invocable_r_v<double, const LeafError&, const ElementOf<Grid>&>)
    HierarchicalIndicator(const Grid& grid, const Field& field, const LeafError& leaf_error,
                          const E& executor = {})
        : epoch_{nestgrid::epoch(grid)}, own_errors_{true} {
        sweep(grid, field, leaf_error, executor);
    }
    template <class Grid, class Field, Executor E = SequentialExecutor>
    HierarchicalIndicator(const Grid& grid, const Field& field, const E& executor = {})
        : epoch_{nestgrid::epoch(grid)} {
        sweep(grid, field, detail::Nothing{}, executor);
    }

    /// The saturated indicator of a node, for S. Nodes of the coarse grid have one too.
    NESTGRID_INLINE float stop(NodeKey node) const { return bfloat16_value(entry(node).stop); }

    /// Of some nodes, those whose stop is at most `limit`, one bit each.
    NESTGRID_INLINE NodeMask stops_at_most(std::span<const NodeKey> nodes, double limit) const {
        if (!(limit >= 0)) return 0;
        const auto most = static_cast<std::uint16_t>(
            std::bit_cast<std::uint32_t>(float_below(limit)) >> 16U);  // in the order of numbers
        NodeMask mask = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            mask |= NodeMask{entry(nodes[i]).stop <= most} << i;
        }
        return mask;
    }

    /// U and P_S U differ by at most this at a node of the finest level that is interpolated.
    double offset_bound(NodeKey node) const { return own_errors_ ? bound(node) : stop(node); }

    /// The bound of a node, for the intersection test.
    NESTGRID_INLINE float bound(NodeKey node) const { return bfloat16_value(entry(node).bound); }

    /// The largest bound of some nodes, eta_H(E) for the new nodes of an element E.
    NESTGRID_INLINE float bound(std::span<const NodeKey> nodes) const {
        std::uint16_t largest = 0;
        for (const NodeKey node : nodes) largest = std::max(largest, entry(node).bound);
        return bfloat16_value(largest);
    }

    /// These will be asked for soon.
    NESTGRID_INLINE void prefetch([[maybe_unused]] std::span<const NodeKey> nodes) const {
#if defined(__GNUC__)
        if (dense_ == nullptr) {
            for (const NodeKey node : nodes) sparse_.prefetch(node);
        } else {
            for (const NodeKey node : nodes) {
                __builtin_prefetch(dense_.get() + static_cast<std::size_t>(node));
            }
        }
#endif
    }

    /// The same for the new nodes of one split; where one look tells of them all, it is enough.
    NESTGRID_INLINE void prefetch(const Rule& rule, std::span<const NodeKey> nodes) const {
        prefetch(rule.inside == no_new_node ? nodes : nodes.subspan(rule.inside, 1));
    }

    /// Both of eight nodes.
    class Known {
    public:
        NESTGRID_INLINE explicit Known(const Pack<std::uint32_t>& bits) : bits_{bits} {}
        NESTGRID_INLINE Pack<float> stop() const { return (bits_ << 16).as<float>(); }
        NESTGRID_INLINE Pack<float> bound() const {
            return (bits_ & Pack<std::uint32_t>::all(0xFFFF0000U)).as<float>();
        }

    private:
        Pack<std::uint32_t> bits_;  // the stop below the bound
    };
    NESTGRID_INLINE Known look_up(const NodeKey* nodes) const {
        if (dense_ != nullptr) {
            const Entry* const entry = dense_.get();
            return Known(Pack<std::uint32_t>::make([&](auto i) NESTGRID_INLINE_LAMBDA {
                return entry[static_cast<std::size_t>(nodes[i])].bits();
            }));
        }
        return look_up_sparse(nodes);
    }

    /// The same for the new nodes of one split.
    NESTGRID_INLINE float bound(const Rule& rule, std::span<const NodeKey> nodes) const {
        return rule.inside == no_new_node ? bound(nodes) : bound(nodes[rule.inside]);
    }

    /// The largest stop of the new nodes of one split, where one look tells; else infinity.
    NESTGRID_INLINE float largest_stop(const Rule& rule, std::span<const NodeKey> nodes) const {
        if (rule.inside == no_new_node) return std::numeric_limits<float>::infinity();
        return stop(nodes[rule.inside]);
    }

    /// Whether elements that stop conform on a grid without hanging nodes, because each split makes
    /// one new node at most (bisection): a saturated S stops all elements at it, or none.
    bool stops_conform() const { return facts_.largest_split <= 1; }

    /// The deepest level, where every split divides all edges and faces of its element, so that
    /// what lies on that level has no finer neighbour; else -1.
    int finest_level() const { return facts_.all_divided ? facts_.finest_level : -1; }

    /// Nodes that hang, where the grid did not say so itself: hand them to every Traversal.
    const HangingNodes* hanging() const { return hanging_.size() > 0 ? &hanging_ : nullptr; }

    /// The largest difference between the field at a hanging node and its interpolant there, where
    /// the field gives one. Not 0 up to rounding: constraints were not distributed. The field is
    /// interpolated there all the same.
    double hanging_violation() const { return facts_.hanging_violation; }

    double least() const { return facts_.least; }        ///< of the values at all nodes
    double greatest() const { return facts_.greatest; }  ///< of the values at all nodes
    std::size_t node_count() const { return node_count_; }
    std::uint64_t epoch() const { return epoch_; }  ///< of the grid this was computed on

    std::size_t memory_bytes() const {
        return (dense_ == nullptr ? 0 : node_count_ * sizeof(Entry)) + sparse_.memory_bytes() +
               hanging_.memory_bytes();
    }

private:
    struct Entry {
        std::uint16_t stop;   // bfloat16, rounded up
        std::uint16_t bound;  // bfloat16, rounded up

        NESTGRID_INLINE std::uint32_t bits() const {
            if constexpr (std::endian::native == std::endian::little) {
                std::uint32_t both;
                std::memcpy(&both, this, sizeof both);
                return both;
            } else {
                return stop | std::uint32_t{bound} << 16U;
            }
        }
        NESTGRID_INLINE static Entry of(std::uint32_t bits) {
            return {static_cast<std::uint16_t>(bits), static_cast<std::uint16_t>(bits >> 16U)};
        }
    };
    NESTGRID_INLINE Entry entry(NodeKey node) const {
        if (dense_ != nullptr) return dense_[static_cast<std::size_t>(node)];
        return sparse_entry(node);
    }
    NESTGRID_NOINLINE Entry sparse_entry(NodeKey node) const {
        const Entry* e = sparse_.find(node);
        return e == nullptr ? Entry{} : *e;
    }

    NESTGRID_NOINLINE Known look_up_sparse(const NodeKey* nodes) const {
        return Known(Pack<std::uint32_t>::make(
            [&](auto i) NESTGRID_INLINE_LAMBDA { return sparse_entry(nodes[i]).bits(); }));
    }

    template <class Grid, class Field, class LeafError, class E>
    void sweep(const Grid& grid, const Field& field, const LeafError& leaf_error,
               const E& executor);
    // indicator_stars.hpp
    template <class Grid>
    void add_splits(const Grid& grid);
    template <class Grid, class Field>
    void sweep_stars(const Grid& grid, const Field& field);
    // indicator_levels.hpp
    class Sweeps;
    template <class Grid, class Field, class LeafError, class E>
    void sweep_levels(const Grid& grid, const Field& field, const LeafError& leaf_error,
                      const E& executor);

    std::unique_ptr<Entry[]> dense_;  // by node, where keys are dense; else null
    KeyTable<NodeKey, Entry> sparse_;
    HangingNodes hanging_;
    detail::PrerollFacts facts_;
    std::size_t node_count_ = 0;
    std::uint64_t epoch_ = 0;
    bool own_errors_ = false;  // of leaves, instead of offsets
};

namespace detail {

template <class Grid, class Field>
concept KnowsStars = KnowsRows<Field> && requires(const Grid& g) {
    g.for_each_star_row([](const StarRow&) {});
};

}  // namespace detail

template <class Grid, class Field, class LeafError, class E>
void HierarchicalIndicator::sweep(const Grid& grid, const Field& field, const LeafError& leaf_error,
                                  const E& executor) {
    static_assert(require_nested_grid<Grid>());
    static_assert(require_nodal_field<Field, Grid>());
    if (hanging_nodes_unknown(grid)) hanging_ = derive_hanging_nodes(grid);
    if constexpr (detail::KnowsStars<Grid, Field> && std::is_same_v<LeafError, detail::Nothing>) {
        if (knows_stars(grid) && knows_stars(field)) {
            sweep_stars(grid, field);
            return;
        }
    }
    sweep_levels(grid, field, leaf_error, executor);
}

}  // namespace nestgrid

#include <nestgrid/algorithms/indicator_levels.hpp>
#include <nestgrid/algorithms/indicator_stars.hpp>
