// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bisections known at compile time, of elements that are nothing but their corners: what lets the
// traversal keep an element in registers.
//
// A grid may offer, beside what it must:
//     using Node                                       a handle of a node, a small value
//     static constexpr std::array<KnownBisection, k> bisections;
//     std::size_t bisection(e)                         which one splits e, where it is split
//     std::array<Node, dimension + 1> nodes(e)
//     Element element(std::size_t number, const std::array<Node, dimension + 1>&)
//     const Rule& rule(std::size_t number)
//     bool halved(Node a, Node b)                      whether an edge to be bisected is
//     Node middle(Node a, Node b)                      its new node
//     NodeKey key(Node)
//     bool whole()                                     that nothing is masked or outside
// They must agree with split(), children(), new_keys() and corner_keys(); its field offers
//     template <bool whole> value_type value_at(Node, NodeKey)
// Nothing hangs in such a grid, and it knows keys, positions and boundary faces by heart.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <nestgrid/traversal.hpp>

namespace nestgrid {

/// The bisection of a simplex of at most four corners; its one new node is the midpoint of two.
struct KnownBisection {
    struct Half {
        std::array<std::uint8_t, 4> corner{};  ///< of the parent, or 4: the new node
        std::uint8_t bisection = 0;            ///< of this child
        std::int8_t orientation = 1;
    };
    std::array<std::uint8_t, 2> parent{};
    std::array<Half, 2> child{};
};

/// Maubach's bisections of triangles (dim 2) and tetrahedra; number i is that of tag i + 1.
template <int dim>
constexpr std::array<KnownBisection, static_cast<std::size_t>(dim)> maubach_bisections() {
    std::array<KnownBisection, static_cast<std::size_t>(dim)> result;
    constexpr auto size = static_cast<std::size_t>(dim);
    for (std::size_t tag = 1; tag <= size; ++tag) {
        KnownBisection& rule = result[tag - 1];
        rule.parent = {0, static_cast<std::uint8_t>(tag)};
        for (std::size_t i = 0; i <= size; ++i) {
            rule.child[0].corner[i] = static_cast<std::uint8_t>(i == tag ? 4 : i);
            rule.child[1].corner[i] = static_cast<std::uint8_t>(i == tag ? 4 : i < tag ? i + 1 : i);
        }
        for (KnownBisection::Half& half : rule.child) {
            half.bisection = static_cast<std::uint8_t>(tag == 1 ? size - 1 : tag - 2);
        }
        rule.child[1].orientation = static_cast<std::int8_t>(tag % 2 == 0 ? 1 : -1);
    }
    return result;
}

template <class Grid, class Field>
concept KnowsBisections = requires(const Grid& grid, const Field& field, const ElementOf<Grid>& e,
                                   typename Grid::Node node) {
    { Grid::bisections.size() } -> std::convertible_to<std::size_t>;
    { grid.bisection(e) } -> std::convertible_to<std::size_t>;
    { grid.element(std::size_t{}, grid.nodes(e)) } -> std::same_as<ElementOf<Grid>>;
    { grid.rule(std::size_t{}) } -> std::same_as<const Rule&>;
    { grid.halved(node, node) } -> std::same_as<bool>;
    { grid.middle(node, node) } -> std::same_as<typename Grid::Node>;
    { grid.key(node) } -> std::same_as<NodeKey>;
    { grid.whole() } -> std::same_as<bool>;
    { field.template value_at<true>(node, NodeKey{}) } -> std::same_as<typename Field::value_type>;
};

/// An element as bisections known at compile time leave it.
template <class Grid, class Real>
struct BisectedElement {
    static constexpr std::size_t corners = static_cast<std::size_t>(Grid::dimension) + 1;

    ElementOf<Grid> element;
    std::array<Real, corners> value;  ///< P_S U at the corners
    int level;
    int orientation;
    Real bound;  ///< what the visitor returned of it
};

/// Walks down from one element. A visitor has
///     Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside)
///             {Visit visit; Real bound;} of an element that is split; lo ... hi: its values
///     bool glance_at_leaf(Real lo, Real hi)      whether to extract it
///     void extract(const BisectedElement&)
///     void tick(looked_at, visited)              now and then
/// \tparam whole  what the grid says
template <class Grid, class Field, class Visitor, bool whole>
class BisectionWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;
    using Bisected = BisectedElement<Grid, Real>;
    static constexpr std::size_t corners = Bisected::corners;

    BisectionWalk(const Grid& grid, const Field& field, Visitor& visitor)
        : grid_{&grid}, field_{&field}, visitor_{&visitor} {}

    void run(const ElementOf<Grid>& e, const Real* value, int level, int orientation) {
        start<0>(e, value, level, orientation);
    }

    std::uint64_t looked_at() const { return 1 + 2 * bisected_ - masked_; }  ///< elements
    /// Of interest to the visitor.
    std::uint64_t visited() const { return bisected_ + extracted_; }

private:
    template <std::size_t number>
    void start(const ElementOf<Grid>& e, const Real* u, int level, int orientation) {
        if constexpr (number + 1 < Grid::bisections.size()) {
            if (grid_->bisection(e) != number) {
                return start<number + 1>(e, u, level, orientation);
            }
        }
        const std::array<Node, corners> n = grid_->nodes(e);
        // Triangles take their last corner twice.
        bisect<number>(n[0], n[1], n[2], n[corners - 1], u[0], u[1], u[2], u[corners - 1],
                       2 * level + (orientation < 0 ? 1 : 0));
    }

    /// \param path twice the level, plus 1 where the orientation is negative
    template <std::size_t number>
    void bisect(Node n0, Node n1, Node n2, Node n3, Real u0, Real u1, Real u2, Real u3, int path);
    template <std::size_t number>
    void extract(Node n0, Node n1, Node n2, Node n3, Real u0, Real u1, Real u2, Real u3, int path,
                 Real bound);

    const Grid* grid_;
    const Field* field_;
    Visitor* visitor_;
    std::uint64_t bisected_ = 0;
    std::uint64_t masked_ = 0;
    std::uint64_t extracted_ = 0;
};

/// Walks down from an element with these values; `end` is told the walk's counts.
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
    const Real lo = std::min(std::min(u0, u1), std::min(u2, u3));
    const Real hi = std::max(std::max(u0, u1), std::max(u2, u3));
    if (!grid_->halved(n[rule.parent[0]], n[rule.parent[1]])) {
        if (visitor_->glance_at_leaf(lo, hi)) {
            extract<number>(n0, n1, n2, n3, u0, u1, u2, u3, path, Real(0));
        }
        return;
    }
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
    if (visit == Visit::stop) {
        return extract<number>(n0, n1, n2, n3, u0, u1, u2, u3, path, bound);
    }
    const Real uz = field_->template value_at<whole>(z, key);
    if ((++bisected_ & 0x3FFFU) == 0) visitor_->tick(looked_at(), visited());
    const auto enter = [&]<std::size_t c>(
                           std::integral_constant<std::size_t, c>) NESTGRID_INLINE_LAMBDA {
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
                ++masked_;
                return;
            }
        }
        bisect<half.bisection>(node(0), node(1), node(2), node(last), value(0), value(1), value(2),
                               value(last), (path + 2) ^ (half.orientation < 0 ? 1 : 0));
    };
    enter(std::integral_constant<std::size_t, 0>{});
    enter(std::integral_constant<std::size_t, 1>{});
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t number>
NESTGRID_NOINLINE void BisectionWalk<Grid, Field, Visitor, whole>::extract(
    Node n0, Node n1, Node n2, Node n3, Real u0, Real u1, Real u2, Real u3, int path, Real bound) {
    ++extracted_;
    const std::array<Node, 4> n{n0, n1, n2, n3};
    const std::array<Real, 4> u{u0, u1, u2, u3};
    std::array<Node, corners> of;
    Bisected s;
    for (std::size_t i = 0; i < corners; ++i) {
        of[i] = n[i];
        s.value[i] = u[i];
    }
    s.element = grid_->element(number, of);
    s.level = path / 2;
    s.orientation = path % 2 == 0 ? 1 : -1;
    s.bound = bound;
    visitor_->extract(s);
}

}  // namespace nestgrid
