// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Traverses bisections known at compile time (known_bisection.hpp). Elements stay in registers;
// where the grid offers patches, PatchWalk takes over and looks at whole patches (patch_walk.hpp).
//
// Invariant: the walk extracts elements in the order of the plain traversal. It may show a visitor
// elements of a patch below one that the visitor skips or stops at; it does not use these answers.
#pragma once

#include <algorithm>
#include <utility>

#include <patches/patch_descent.hpp>

namespace nestgrid::engine {

/// Walks down from one element. A visitor has
///     Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside)
///             decides about an element that `rule` splits and whose corner values lie in
///             lo ... hi; `node` is its new node; returns {Visit visit; Real bound;}
///     bool glance_at_leaf(Real lo, Real hi)   whether to extract a leaf
///     unsigned extract(const PatchBatch&, const BatchSelection&)
///             extracts the selection
///     void tick(looked_at, visited)           called now and then with the counts so far
/// and, to be shown patches, what PatchWalk asks for.
/// \tparam whole Grid::whole()
template <class Grid, class Field, class Visitor, bool whole>
class BisectionWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;
    using Batch = PatchBatch<Grid, Real>;
    static constexpr std::size_t corners = Batch::pattern.corners;

    BisectionWalk(const Grid& grid, const Field& field, Visitor& visitor)
        : grid_{&grid}, field_{&field}, visitor_{&visitor} {
        pending_.begin(grid, 0);
    }

    /// Walks e and all below it.
    /// \param value the values at the corners of e
    void run(const ElementOf<Grid>& e, const Real* value, int level, int orientation) {
        start<0>(e, value, level, orientation);
        extract_pending();
    }

    /// Number of elements that the visitor decided about.
    std::uint64_t looked_at() const { return count_.looked_at(); }
    /// Number of elements that the walk entered or extracted.
    std::uint64_t visited() const { return count_.visited(); }

private:
    static constexpr std::size_t last_ = Grid::bisections.size() - 1;
    static constexpr bool in_patches_ = [] {
        if constexpr ((whole || TellsWhereWhole<Grid>)&&KnowsPatches<Grid> && Packable<Real>) {
            return requires(Visitor & v, const PackedElements<Real>& e) { v.glance(e); }
            || requires(Visitor & v, const PackedPatches<Real>& b) {
                v.template see<PatchParts::ends>(b);
            };
        }
        return false;
    }();

    template <std::size_t number>
    void start(const ElementOf<Grid>& e, const Real* u, int level, int orientation) {
        if constexpr (number < last_) {
            if (grid_->bisection(e) != number) {
                return start<number + 1>(e, u, level, orientation);
            }
        }
        const std::array<Node, corners> n = grid_->nodes(e);
        // A triangle passes its last corner twice.
        bisect<number>(n[0], n[1], n[2], n[corners - 1], u[0], u[1], u[2], u[corners - 1],
                       2 * level + (orientation < 0 ? 1 : 0));
    }

    /// Decides about an element and walks below it.
    /// \tparam number the bisection that splits it
    /// \param path twice the level, plus 1 where the orientation is negative
    template <std::size_t number>
    void bisect(Node n0, Node n1, Node n2, Node n3, Real u0, Real u1, Real u2, Real u3, int path);
    template <std::size_t number>
    void extract(const std::array<Node, 4>& n, const std::array<Real, 4>& u, int path, Real bound);
    void extract_pending();
    /// Whether PatchWalk may take the element with corners n: whether it is whole.
    bool may_walk_patches(const std::array<Node, 4>& n) const {
        if constexpr (whole) {
            return true;
        } else {
            std::array<Node, corners> of;
            std::copy_n(n.begin(), corners, of.begin());
            return grid_->whole(of);
        }
    }

    const Grid* grid_;
    const Field* field_;
    Visitor* visitor_;
    WalkCounts count_;
    Batch pending_;  // elements to be extracted together
    BatchSelection selection_;
};

/// Walks down from e with `value` at its corners, and calls end(walk) afterwards, which may read
/// the counts.
template <class Grid, class Field, class Visitor, class End>
void walk_bisections(const Grid& grid, const Field& field, Visitor& visitor,
                     const ElementOf<Grid>& e, const typename Field::value_type* value, int level,
                     int orientation, End&& end) {
    const auto run = [&](auto whole) {
        BisectionWalk<Grid, Field, Visitor, whole.value> walk(grid, field, visitor);
        walk.run(e, value, level, orientation);
        end(walk);
    };
    grid.whole() ? run(std::true_type{}) : run(std::false_type{});
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t number>
void BisectionWalk<Grid, Field, Visitor, whole>::bisect(Node n0, Node n1, Node n2, Node n3, Real u0,
                                                        Real u1, Real u2, Real u3, int path) {
    constexpr KnownBisection rule = Grid::bisections[number];
    const std::array<Node, 4> n{n0, n1, n2, n3};
    const std::array<Real, 4> u{u0, u1, u2, u3};
    const auto [lo, hi] = range_of(u);
    if (!grid_->halved(n[rule.parent[0]], n[rule.parent[1]])) {
        if (visitor_->glance_at_leaf(lo, hi)) extract<number>(n, u, path, Real(0));
        return;
    }
    if constexpr (in_patches_ && number == last_) {
        if (may_walk_patches(n)) {
            extract_pending();
            PatchWalk<Grid, Field, Visitor> patches(*grid_, *field_, *visitor_, count_);
            return patches.run(n, u, path);
        }
    }
    if constexpr (!in_patches_ || !whole || number != last_) {
        const Node z = grid_->middle(n[rule.parent[0]], n[rule.parent[1]]);
        bool outside = false;
        if constexpr (!whole && may_offer<Grid>(Feature::outside)) {
            std::array<Node, corners> of;
            std::copy_n(n.begin(), corners, of.begin());
            outside = grid_->outside(grid_->element(number, of)) != 0;
        }
        const NodeKey key = grid_->key(z);
        const auto [visit, bound] =
            visitor_->glance(lo, hi, grid_->rule(number), key, path / 2, outside);
        if (visit == Visit::skip) return;
        if (visit == Visit::stop) return extract<number>(n, u, path, bound);
        count_.bisect(1, *visitor_);
        const Real uz = [&]() NESTGRID_INLINE_LAMBDA -> Real {
            if constexpr (GivesMeans<Field>) {
                return field_->mean(u[rule.parent[0]], u[rule.parent[1]]);
            } else {
                return field_->template value_at<whole>(z, key);
            }
        }();
        unrolled<2>([&](auto c) NESTGRID_INLINE_LAMBDA {
            constexpr KnownBisection::Half half = rule.child[c];
            const auto node = [&](std::size_t i) {
                return half.corner[i] == 4 ? z : n[half.corner[i]];
            };
            const auto value = [&](std::size_t i) {
                return half.corner[i] == 4 ? uz : u[half.corner[i]];
            };
            constexpr std::size_t last = corners - 1;
            if constexpr (!whole && may_offer<Grid>(Feature::masked)) {
                std::array<Node, corners> of;
                for (std::size_t i = 0; i < corners; ++i) of[i] = node(i);
                if (grid_->masked(grid_->element(half.bisection, of))) {
                    ++count_.masked;
                    return;
                }
            }
            bisect<half.bisection>(node(0), node(1), node(2), node(last), value(0), value(1),
                                   value(2), value(last),
                                   (path + 2) ^ (half.orientation < 0 ? 1 : 0));
        });
    }
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t number>
NESTGRID_NOINLINE void BisectionWalk<Grid, Field, Visitor, whole>::extract(
    const std::array<Node, 4>& n, const std::array<Real, 4>& u, int path, Real bound) {
    ++count_.extracted;
    selection_.add(Batch::room + pending_.element_count);
    pending_.put_element(number, n, u, path / 2, path % 2 != 0, bound);
    if (pending_.element_count == Batch::room) extract_pending();
}

template <class Grid, class Field, class Visitor, bool whole>
void BisectionWalk<Grid, Field, Visitor, whole>::extract_pending() {
    if (selection_.count == 0) return;
    pending_.fill_up_elements();
    visitor_->extract(std::as_const(pending_), selection_);
    pending_.element_count = 0;
    selection_.clear();
}

}  // namespace nestgrid::engine
