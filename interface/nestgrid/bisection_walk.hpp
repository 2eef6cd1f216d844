// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The traversal of bisections known at compile time: elements stay in registers, and where the grid
// says so, whole blocks of them are looked at together.
//
// Invariant: elements are shown, and extracted, in the order of the plain traversal; a visitor may
// be shown elements of a block below one that it skips or stops at, and those answers are not used.
#pragma once

#include <bit>

#include <nestgrid/bisection_block.hpp>
#include <nestgrid/inlining.hpp>

namespace nestgrid {

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

/// A block whose ends are leaves and at none of whose elements the visitor stops.
template <class Grid, class Real>
struct BisectedBlock {
    using Node = typename Grid::Node;
    static constexpr const auto& pattern = block_of<Grid>;

    const Grid* grid;
    std::array<Node, pattern.nodes> node;
    std::array<NodeKey, pattern.nodes> key;  ///< of the new nodes
    std::array<Real, pattern.nodes> value;
    int level;        ///< of part 1
    int orientation;  ///< of part 1

    Point position(std::size_t i) const { return grid->position(node[i]); }
    NodeKey node_key(std::size_t i) const {
        return i < BisectedElement<Grid, Real>::corners ? grid->key(node[i]) : key[i];
    }
    /// Faces on the boundary of the domain, one bit each.
    unsigned boundary(std::size_t part) const { return grid->boundary_faces(element(part)); }
    ElementOf<Grid> element(std::size_t part) const {
        constexpr std::size_t corners = BisectedElement<Grid, Real>::corners;
        std::array<Node, corners> of;
        for (std::size_t i = 0; i < corners; ++i) of[i] = node[pattern.part[part].corner[i]];
        return grid->element(pattern.part[part].bisection, of);
    }
};

/// What a visitor makes of the elements of a block: one bit for each.
template <class Real, std::size_t count>
struct BlockGlance {
    unsigned descend = 0;
    unsigned stop = 0;
    std::array<Real, count> bound{};
};

/// The elements of a block that are split, part 1 excepted: place i of each array is part i + 2.
template <class Real, std::size_t count>
struct BlockInterior {
    static constexpr std::size_t size = count;
    using Glance = BlockGlance<Real, count>;

    std::array<Real, count> lo;
    std::array<Real, count> hi;  ///< lo ... hi: values at the corners
    std::array<NodeKey, count> key;
    std::array<const Rule*, count> rule;
    std::array<int, count> level;
};

/// Walks down from one element. A visitor has
///     Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside)
///             {Visit visit; Real bound;} of an element that is split; lo ... hi: its values
///     bool glance_at_leaf(Real lo, Real hi)      whether to extract it
///     void extract(const BisectedElement&)
///     void tick(looked_at, visited)              now and then
/// and, to be shown blocks,
///     BlockGlance glance_within(const BlockInterior&)    what glance() says of each of them
///     unsigned extract_block(const BisectedBlock&, unsigned entered)
///             extracts those of the leaves entered of which glance_at_leaf() says so, and says
///             which; bit i stands for end i
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
    static constexpr std::size_t last_ = Grid::bisections.size() - 1;
    static constexpr bool in_blocks_ = [] {
        if constexpr (whole && KnowsBlocks<Grid>) {
            return requires(Visitor & v, const BisectedBlock<Grid, Real>& b) {
                v.extract_block(b, 0U);
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

    /// What lies below an element that starts a block and is entered; z: its new node.
    void enter_block(Node n0, Node n1, Node n2, Node n3, Real u0, Real u1, Real u2, Real u3, Node z,
                     NodeKey key, int path);
    template <std::size_t part, class Block, class Glance>
    void enter_part(const Block& block, const Glance& glance, int path);

    void count_bisected(std::uint64_t more) {
        bisected_ += more;
        if (bisected_ < next_tick_) return;
        next_tick_ = bisected_ + 0x4000U;
        visitor_->tick(looked_at(), visited());
    }

    const Grid* grid_;
    const Field* field_;
    Visitor* visitor_;
    std::uint64_t bisected_ = 0;
    std::uint64_t next_tick_ = 0x4000U;
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
    count_bisected(1);
    if constexpr (in_blocks_ && number == last_) {
        enter_block(n0, n1, n2, n3, u0, u1, u2, u3, z, key, path);
    } else {
        const Real uz = field_->template value_at<whole>(z, key);
        const auto enter =
            [&]<std::size_t c>(std::integral_constant<std::size_t, c>) NESTGRID_INLINE_LAMBDA {
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
                bisect<half.bisection>(node(0), node(1), node(2), node(last), value(0), value(1),
                                       value(2), value(last),
                                       (path + 2) ^ (half.orientation < 0 ? 1 : 0));
            };
        enter(std::integral_constant<std::size_t, 0>{});
        enter(std::integral_constant<std::size_t, 1>{});
    }
}

template <class Grid, class Field, class Visitor, bool whole>
void BisectionWalk<Grid, Field, Visitor, whole>::enter_block(Node n0, Node n1, Node n2, Node n3,
                                                             Real u0, Real u1, Real u2, Real u3,
                                                             Node z, NodeKey key, int path) {
    static constexpr const auto& pattern = block_of<Grid>;
    constexpr std::size_t inner = pattern.ends - 2;
    BisectedBlock<Grid, Real> block;
    const std::array<Node, 4> n{n0, n1, n2, n3};
    const std::array<Real, 4> u{u0, u1, u2, u3};
    for (std::size_t i = 0; i < corners; ++i) {
        block.node[i] = n[i];
        block.value[i] = u[i];
    }
    block.node[corners] = z;
    block.key[corners] = key;
    block.value[corners] = field_->template value_at<whole>(z, key);
    for (std::size_t i = corners + 1; i < pattern.nodes; ++i) {
        block.node[i] =
            grid_->middle(block.node[pattern.parent[i][0]], block.node[pattern.parent[i][1]]);
        block.key[i] = grid_->key(block.node[i]);
        block.value[i] = field_->template value_at<whole>(block.node[i], block.key[i]);
    }
    BlockInterior<Real, inner> interior;
    [&]<std::size_t... i>(std::index_sequence<i...>) {
        const auto fill = [&](std::size_t at, const auto& part) NESTGRID_INLINE_LAMBDA {
            const auto value = [&](std::size_t k) { return block.value[part.corner[k]]; };
            interior.lo[at] = std::min(std::min(value(0), value(1)), std::min(value(2), value(3)));
            interior.hi[at] = std::max(std::max(value(0), value(1)), std::max(value(2), value(3)));
            interior.key[at] = block.key[part.middle];
            interior.rule[at] = &grid_->rule(part.bisection);
            interior.level[at] = path / 2 + part.depth;
        };
        (fill(i, pattern.part[i + 2]), ...);
    }
    (std::make_index_sequence<inner>());
    auto glance = visitor_->glance_within(interior);
    // One bit for each part; those below one that is not entered are not reached.
    unsigned reached = 2U | 4U | 8U;
    glance.descend = glance.descend << 2U | 2U;
    glance.stop <<= 2U;
    for (std::size_t p = 2; p < pattern.ends; ++p) {
        const unsigned entered = reached >> p & glance.descend >> p & 1U;
        reached |= (entered * 3U) << (2 * p);
    }
    glance.descend &= reached;
    glance.stop &= reached;
    count_bisected(static_cast<std::uint64_t>(std::popcount(glance.descend)) - 1);
    constexpr auto first = pattern.part[pattern.ends];
    constexpr KnownBisection next = Grid::bisections[first.bisection];
    if (glance.stop == 0 && !grid_->halved(block.node[first.corner[next.parent[0]]],
                                           block.node[first.corner[next.parent[1]]])) {
        block.grid = grid_;
        block.level = path / 2;
        block.orientation = path % 2 == 0 ? 1 : -1;
        const unsigned extracted = visitor_->extract_block(block, reached >> pattern.ends);
        extracted_ += static_cast<std::uint64_t>(std::popcount(extracted));
        return;
    }
    enter_part<2>(block, glance, path);
    enter_part<3>(block, glance, path);
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t p, class Block, class Glance>
NESTGRID_INLINE void BisectionWalk<Grid, Field, Visitor, whole>::enter_part(const Block& block,
                                                                            const Glance& glance,
                                                                            int path) {
    static constexpr const auto& pattern = block_of<Grid>;
    constexpr auto part = pattern.part[p];
    const auto node = [&](std::size_t i) { return block.node[part.corner[i]]; };
    const auto value = [&](std::size_t i) { return block.value[part.corner[i]]; };
    const int its_path = (path + 2 * part.depth) ^ (part.mirrored ? 1 : 0);
    if constexpr (p >= pattern.ends) {
        bisect<part.bisection>(node(0), node(1), node(2), node(3), value(0), value(1), value(2),
                               value(3), its_path);
    } else if ((glance.descend >> p & 1U) != 0) {
        enter_part<2 * p>(block, glance, path);
        enter_part<2 * p + 1>(block, glance, path);
    } else if ((glance.stop >> p & 1U) != 0) {
        extract<part.bisection>(node(0), node(1), node(2), node(3), value(0), value(1), value(2),
                                value(3), its_path, glance.bound[p - 2]);
    }
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
