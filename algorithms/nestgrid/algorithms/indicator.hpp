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
//     are themselves new nodes of something, but for deviations;
//   - these also for a parent of a new node that is a new node of the same split;
//   - stop and bound of a new node inside the element are not below those of all its new nodes, so
//     that one look tells.
// Deviations may take the place of offsets in both (NodeError::deviation). The deviation of an
// element is the greatest |U - I U| at all nodes that are made in it, at any depth, where I
// interpolates between its corners; |U - I U| on the element is no greater.
//   bound  the greatest deviation of the elements whose split makes the node;
//   stop   the same, saturated; where a split makes several nodes, also the deviation of a child
//          with the offsets of those of its corners that may be dropped while others are kept.
// So |U - P_S U| <= epsilon holds at all nodes where S = (stop <= epsilon), which a threshold on
// offsets does not promise: there up to 1.97 times epsilon was measured. These bounds are those of
// elements, exact but for rounding up; they are not sums over finer nodes.
// A solver's own error indicator, one number per leaf, may take the place of the offsets in `stop`:
// that of a node is then the largest of the leaves around it, saturated likewise. Bounds always
// come from the data. Both are rounded up to bfloat16, every sum at once, so that the invariants
// hold exactly for the numbers that are kept.
// Memory: O(nodes), 4 bytes (plus 16 to 48 for a hash table where node keys are not dense); while
// it is built nothing more where the grid knows stars, else 12, and 4 for each node of each split.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <memory>

#include <nestgrid/algorithms/criterion.hpp>
#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/detail/erase.hpp>
#include <nestgrid/detail/hanging.hpp>
#include <nestgrid/detail/key_table.hpp>

namespace nestgrid {

/// How far U may be from what is known of it, at every node: what guides the search.
class Bounds {
public:
    virtual ~Bounds() = default;
    /// At a node of the finest level that is interpolated, U and P_S U differ by at most this.
    virtual double offset_bound(NodeKey node) const = 0;
    /// On an element with these new nodes U stays within corner values +- this.
    virtual double bound(const Rule& rule, std::span<const NodeKey> nodes) const = 0;
    /// Whether U and P_S U differ on an element that stops by at most offset_bound() of any corner
    /// that is interpolated, not only at that corner.
    virtual bool corners_bound_elements() const { return false; }
    /// Nodes that hang, where the grid does not say so itself; or null.
    virtual const HangingNodes* hanging() const = 0;
    /// Whether this was computed on the grid in the state of this epoch.
    virtual bool made_for(std::uint64_t epoch) const = 0;
    /// No value of component 0 is less; minus infinity where this is not known.
    virtual double least() const { return -std::numeric_limits<double>::infinity(); }
    /// No value of component 0 is greater; infinity where this is not known.
    virtual double greatest() const { return std::numeric_limits<double>::infinity(); }
    /// Whether elements that stop conform on a grid without hanging nodes.
    virtual bool stops_conform() const { return false; }
    /// A level on which no element has a finer neighbour, or -1 where none is known.
    virtual int finest_level() const { return -1; }
    /// Whether every node is known to be created on one level of the hierarchy only.
    virtual bool one_level_a_node() const { return false; }

protected:
    Bounds() = default;
    Bounds(const Bounds&) = default;
    Bounds& operator=(const Bounds&) = default;
    Bounds(Bounds&&) noexcept = default;
    Bounds& operator=(Bounds&&) noexcept = default;
};

/// What a HierarchicalIndicator measures.
enum class NodeError : std::uint8_t {
    offset,     ///< |U - sum omega U| at nodes: the preroll is cheapest
    deviation,  ///< |U - I U| on elements: the threshold is what U and P_S U differ by at most
};

/// The error of a leaf: not negative. Called by several threads where the executor has several.
using LeafErrors = std::function<double(const Handle& leaf)>;

/// Whether anything has changed within the hull of some points, which are the corners of an element
/// or one node: a value at a node there, or the refinement of an element that reaches there.
using ChangedPlaces = std::function<bool(std::span<const Point> points)>;

/// Whether the box around some points meets a box, in which everything lies that has changed. For
/// grids whose elements lie within the hull of their corners.
struct ChangedBox {
    Point low;
    Point high;

    bool operator()(std::span<const Point> points) const;
};

namespace detail {

/// Stop and bound of a node as bfloat16, rounded up.
struct IndicatorEntry {
    std::uint16_t stop;
    std::uint16_t bound;
};

/// The entries of all nodes.
struct IndicatorEntries {
    std::unique_ptr<IndicatorEntry[]> dense;  ///< by node, where keys are dense; else null
    KeyTable<NodeKey, IndicatorEntry> sparse;

    NESTGRID_INLINE IndicatorEntry at(NodeKey node) const {
        if (dense != nullptr) return dense[static_cast<std::size_t>(node)];
        return at_sparse(node);
    }
    /// Sets the entry of a node; dense keys must have room.
    void put(NodeKey node, const IndicatorEntry& entry) {
        if (dense != nullptr) {
            dense[static_cast<std::size_t>(node)] = entry;
        } else {
            *sparse.insert(node, entry).first = entry;
        }
    }
    /// Makes room for another number of dense keys.
    void resize(std::size_t from, std::size_t to);
    NESTGRID_NOINLINE IndicatorEntry at_sparse(NodeKey node) const {
        const IndicatorEntry* e = sparse.find(node);
        return e == nullptr ? IndicatorEntry{} : *e;
    }
};

/// What a preroll learns beside the entries. All of it is a least or a greatest, so that the order
/// does not count.
struct PrerollFacts {
    double least = std::numeric_limits<double>::infinity();
    double greatest = -std::numeric_limits<double>::infinity();
    double hanging_violation = 0;
    std::size_t largest_split = 0;  ///< number of new nodes
    int finest_level = 0;
    int longest_chain = 1;         ///< of new nodes of one split that are parents of each other
    bool all_divided = true;       ///< every rule divides all edges and faces
    bool one_level_a_node = true;  ///< every node is created on one level only
    double least_stop = 0;         ///< of the greatest `stop` at the new nodes of a split

    void add(const PrerollFacts& other);
    /// \throw InvalidInput where the value is not a number, infinite, or beyond the limit
    void add_value(double value, double limit) {
        if (!(std::abs(value) <= limit)) refuse(value);
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }

private:
    [[noreturn]] static void refuse(double value);
};

template <class T>
concept AnyHierarchy =
    std::derived_from<T, Hierarchy<float>> || std::derived_from<T, Hierarchy<double>>;

}  // namespace detail

/// How far new nodes are from the means of their parents, saturated; and what bounds it.
class HierarchicalIndicator final : public Indicator, public Bounds {
public:
    /// Walks the whole hierarchy; component 0 of the field counts.
    /// \throw InvalidInput where a value is not a number, infinite, or beyond a quarter of the
    ///        range of its type
    /// \param executor of several threads, or of one; the result does not depend on it
    template <class Grid, class Field>
        requires(!detail::AnyHierarchy<Grid>)
    HierarchicalIndicator(const Grid& grid, const Field& field,
                          const Executor& executor = SequentialExecutor{})
        : HierarchicalIndicator(erase(grid, field), LeafErrors{}, executor) {}
    /// \param spread how `stop` is handed from finer nodes to coarser ones
    /// \throw InvalidInput also where the factor is below 1 or the slope below 0
    template <class Grid, class Field>
        requires(!detail::AnyHierarchy<Grid>)
    HierarchicalIndicator(const Grid& grid, const Field& field, const Spread& spread,
                          const Executor& executor = SequentialExecutor{})
        : HierarchicalIndicator(erase(grid, field), LeafErrors{}, executor, spread) {}
    /// \param error what is measured; deviations take up to twice the time of offsets
    template <class Grid, class Field>
        requires(!detail::AnyHierarchy<Grid>)
    HierarchicalIndicator(const Grid& grid, const Field& field, NodeError error,
                          const Executor& executor = SequentialExecutor{},
                          const Spread& spread = {})
        : HierarchicalIndicator(erase(grid, field), error, executor, spread) {}
    /// \param leaf_error errors of leaves in the place of offsets, such as a Kelly or residual
    ///        estimate; then thresholds have their unit. Called as double(const Element&) for every
    ///        leaf
    /// \throw InvalidInput also where an error is negative or not a number
    template <class Grid, class Field, class LeafError>
        requires(std::is_invocable_r_v<double, const LeafError&, const ElementOf<Grid>&>)
    HierarchicalIndicator(const Grid& grid, const Field& field, const LeafError& leaf_error,
                          const Executor& executor = SequentialExecutor{})
        : HierarchicalIndicator(
              erase(grid, field),
              [&leaf_error](const Handle& leaf) {
                  return static_cast<double>(leaf_error(detail::element_of<ElementOf<Grid>>(leaf)));
              },
              executor) {}
    /// The same for a hierarchy; leaf_errors may be empty.
    explicit HierarchicalIndicator(const Hierarchy<float>& hierarchy,
                                   const LeafErrors& leaf_errors = {},
                                   const Executor& executor = SequentialExecutor{},
                                   const Spread& spread = {});
    explicit HierarchicalIndicator(const Hierarchy<double>& hierarchy,
                                   const LeafErrors& leaf_errors = {},
                                   const Executor& executor = SequentialExecutor{},
                                   const Spread& spread = {});
    HierarchicalIndicator(const Hierarchy<float>& hierarchy, NodeError error,
                          const Executor& executor = SequentialExecutor{},
                          const Spread& spread = {});
    HierarchicalIndicator(const Hierarchy<double>& hierarchy, NodeError error,
                          const Executor& executor = SequentialExecutor{},
                          const Spread& spread = {});

    /// Makes this the indicator of the field as it is now, at a cost that depends on what has
    /// changed and not on the size of the grid: bit for bit what a new one would be, but that
    /// least() and greatest() also count values of before. The grid may have been refined and
    /// coarsened, too, where nodes keep their keys; hanging nodes that it does not name are then
    /// found by a walk over all of it. One of deviations is made anew, by a whole preroll. The
    /// indicator stays as it was where this throws.
    /// \throw InvalidInput as the constructors do, and where errors of leaves are missing
    template <class Grid, class Field>
        requires(!detail::AnyHierarchy<Grid>)
    void update(const Grid& grid, const Field& field, const ChangedPlaces& changed) {
        update(erase(grid, field), changed);
    }
    /// \param leaf_errors errors of leaves, where it was made of these
    void update(const Hierarchy<float>& hierarchy, const ChangedPlaces& changed,
                const LeafErrors& leaf_errors = {});
    void update(const Hierarchy<double>& hierarchy, const ChangedPlaces& changed,
                const LeafErrors& leaf_errors = {});

    /// The saturated indicator of a node, for S. Nodes of the coarse grid have one too.
    double stop(NodeKey node) const override {
        return detail::bfloat16_value(entries_.at(node).stop);
    }
    NodeMask stops_at_most(const Rule& rule, std::span<const NodeKey> nodes,
                           double epsilon) const override {
        if (!(epsilon >= 0)) return 0;
        const std::uint16_t most = detail::bfloat16_below(epsilon);
        if (rule.inside != no_new_node && entries_.at(nodes[rule.inside]).stop <= most) {
            return rule.all();
        }
        NodeMask mask = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            mask |= NodeMask{entries_.at(nodes[i]).stop <= most} << i;
        }
        return mask;
    }

    double least_stop() const override { return facts_.least_stop; }
    Spread spread() const override { return spread_; }
    NodeError error() const { return error_; }
    bool corners_bound_elements() const override { return error_ == NodeError::deviation; }

    double offset_bound(NodeKey node) const override {
        return own_errors_ ? double{bound(node)} : stop(node);
    }
    /// The bound of a node, for the intersection test.
    float bound(NodeKey node) const { return detail::bfloat16_value(entries_.at(node).bound); }
    double bound(const Rule& rule, std::span<const NodeKey> nodes) const override {
        if (rule.inside != no_new_node) return bound(nodes[rule.inside]);
        std::uint16_t largest = 0;
        for (const NodeKey node : nodes) largest = std::max(largest, entries_.at(node).bound);
        return detail::bfloat16_value(largest);
    }

    /// Elements that stop conform on a grid without hanging nodes where each split makes one new
    /// node at most (bisection): a saturated S stops all elements at it, or none.
    bool stops_conform() const override { return facts_.largest_split <= 1; }
    /// The deepest level, where every split divides all edges and faces of its element, so that no
    /// element of that level has a finer neighbour; else -1.
    int finest_level() const override { return facts_.all_divided ? facts_.finest_level : -1; }
    bool one_level_a_node() const override { return facts_.one_level_a_node; }
    /// Nodes that hang, where the grid did not say so itself: hand them to every walk.
    const HangingNodes* hanging() const override { return hanging_.empty() ? nullptr : &hanging_; }

    /// The largest difference between the field at a hanging node and its interpolant there, where
    /// the field gives one. More than rounding says that constraints were not distributed, or that
    /// elements of degree > 1 are curved there. The field is interpolated there all the same.
    double hanging_violation() const { return facts_.hanging_violation; }

    double least() const override { return facts_.least; }        ///< of the values at all nodes
    double greatest() const override { return facts_.greatest; }  ///< of the values at all nodes
    std::size_t node_count() const { return node_count_; }
    std::uint64_t epoch() const { return epoch_; }  ///< of the grid this was computed on
    bool made_for(std::uint64_t epoch) const override { return epoch == epoch_; }

    /// Every node is made of nodes of the coarse grid by at most so many means, one of the other.
    int generations() const { return facts_.finest_level * facts_.longest_chain; }
    /// The greatest relative error of one rounded operation on values of the field.
    double roundoff() const { return roundoff_; }

    std::size_t memory_bytes() const;

    const detail::IndicatorEntries& entries() const { return entries_; }

private:
    template <class Real>
    void prepare(const Hierarchy<Real>& hierarchy, const LeafErrors& leaf_errors,
                 const Executor& executor);
    template <class Real>
    void update_dirty(const Hierarchy<Real>& hierarchy, const ChangedPlaces& changed,
                      const LeafErrors& leaf_errors);

    detail::IndicatorEntries entries_;
    HangingNodes hanging_;
    detail::PrerollFacts facts_;
    Spread spread_;
    std::size_t node_count_ = 0;
    std::uint64_t epoch_ = 0;
    double roundoff_ = 0;
    NodeError error_ = NodeError::offset;
    bool own_errors_ = false;  // of leaves, instead of offsets
};

}  // namespace nestgrid
