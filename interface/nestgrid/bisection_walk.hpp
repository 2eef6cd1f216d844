// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The traversal of bisections known at compile time: elements stay in registers, and where the grid
// says so, whole blocks of them are looked at together.
//
// Invariant: elements are shown, and extracted, in the order of the plain traversal; a visitor may
// be shown elements of a block below one that it skips or stops at, and those answers are not used.
#pragma once

#include <algorithm>
#include <tuple>
#include <utility>

#include <nestgrid/bisection_block.hpp>
#include <nestgrid/inlining.hpp>

namespace nestgrid {

/// Which faces of the subtree a node is in the node lies on, one bit each: edges whose ends share
/// none are edges of no element outside it.
using SubtreeFaces = std::uint8_t;
inline constexpr SubtreeFaces no_subtree = 0x80;

/// A block, or as much of it as is known: of an element that is extracted alone, the corners.
template <class Grid, class Real>
struct BisectedBlock {
    using Node = typename Grid::Node;
    static constexpr const auto& pattern = block_of<Grid>;

    const Grid* grid;
    std::array<Node, pattern.nodes> node;
    std::array<NodeKey, pattern.nodes> key;
    std::array<Real, pattern.nodes> value;  ///< P_S U
    std::array<SubtreeFaces, pattern.nodes> faces;
    std::size_t bisection;  ///< number of the one of part 1
    int level;              ///< of part 1
    int orientation;        ///< of part 1

    NESTGRID_INLINE Point position(std::size_t i) const { return grid->position(node[i]); }
    NESTGRID_INLINE void all_positions(std::array<Point, pattern.nodes>& x) const {
        for (std::size_t i = 0; i < pattern.nodes; ++i) x[i] = position(i);
    }
    /// Faces on the boundary of the domain, one bit each.
    unsigned boundary(std::size_t part) const { return grid->boundary_faces(element(part)); }
    ElementOf<Grid> element(std::size_t part) const {
        const auto& which = pattern.part[part];
        std::array<Node, pattern.corners> of;
        for (std::size_t i = 0; i < of.size(); ++i) of[i] = node[which.corner[i]];
        return grid->element(part == 1 ? bisection : which.bisection, of);
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
///     void extract_part(const BisectedBlock&, std::size_t part, Real bound)
///             an element; bound: what glance() returned of it, or 0 for a leaf
///     void tick(looked_at, visited)              now and then
/// and, to be shown blocks,
///     BlockGlance glance_within(const BlockInterior&)    what glance() says of each of them
///     unsigned extract_block(const BisectedBlock&, unsigned entered)
///             extracts those of the ends entered of which glance_at_leaf() says so, and says how
///             many; bit i stands for end i. All ends are leaves
///     void begin_subtree()                       optional, to be told of faces: what was inside
///                                                the subtree before comes never again
/// \tparam whole  what the grid says
template <class Grid, class Field, class Visitor, bool whole>
class BisectionWalk {
public:
    using Real = typename Field::value_type;
    using Node = typename Grid::Node;
    using Block = BisectedBlock<Grid, Real>;
    static constexpr std::size_t corners = Block::pattern.corners;

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
            return requires(Visitor & v, const Block& b) { v.extract_block(b, 0U); };
        }
        return false;
    }();
    static constexpr bool in_subtrees_ = requires(Visitor & v) { v.begin_subtree(); };
    /// Three blocks of tetrahedra: 512 leaves, of whose edges half lie inside.
    static constexpr int subtree_height_ = 3;

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
    void extract(const std::array<Node, 4>& n, const std::array<Real, 4>& u, int path, Real bound);

    /// Walks down from an element that starts a block, given by places in the block above.
    void walk_block(const Block& above, const std::array<std::uint8_t, 4>& corner, int path);
    template <std::size_t part, class Glance>
    void walk_part(const Block& block, const Glance& glance, bool leaves, int path);
    void extract_part(const Block& block, std::size_t part, Real bound) {
        ++extracted_;
        visitor_->extract_part(block, part, bound);
    }
    void begin_subtree(Block& block);

    NESTGRID_INLINE static std::pair<Real, Real> range(const std::array<Real, 4>& u) {
        return {std::min(std::min(u[0], u[1]), std::min(u[2], u[3])),
                std::max(std::max(u[0], u[1]), std::max(u[2], u[3]))};
    }
    NESTGRID_INLINE static std::pair<Real, Real> range(const Block& block,
                                                       const std::array<std::uint8_t, 4>& corner) {
        return range({block.value[corner[0]], block.value[corner[1]], block.value[corner[2]],
                      block.value[corner[3]]});
    }
    NESTGRID_INLINE void begin_block(Block& block, std::size_t number, int path) const {
        block.grid = grid_;
        block.bisection = number;
        block.level = path / 2;
        block.orientation = path % 2 == 0 ? 1 : -1;
    }
    /// One that is an element alone, in no subtree.
    Block make_alone(std::size_t number, const std::array<Node, 4>& n, const std::array<Real, 4>& u,
                     int path) const {
        Block block;
        begin_block(block, number, path);
        for (std::size_t i = 0; i < corners; ++i) {
            block.node[i] = n[i];
            block.key[i] = grid_->key(n[i]);
            block.value[i] = u[i];
            block.faces[i] = no_subtree;
        }
        return block;
    }

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
    int subtree_level_ = 0;  // on which subtrees start
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
    const auto [lo, hi] = range(u);
    if (!grid_->halved(n[rule.parent[0]], n[rule.parent[1]])) {
        if (visitor_->glance_at_leaf(lo, hi)) extract<number>(n, u, path, Real(0));
        return;
    }
    if constexpr (in_blocks_ && number == last_) {
        // The deepest a block can be that is as deep everywhere.
        int blocks = 0;
        for (Node a = n[rule.parent[0]], b = n[rule.parent[1]]; grid_->halved(a, b); ++blocks) {
            b = grid_->middle(a, b);
        }
        const int above_subtree = std::max(0, blocks - subtree_height_);
        subtree_level_ = path / 2 + static_cast<int>(Grid::block_height) * above_subtree;
        return walk_block(make_alone(number, n, u, path), block_of<Grid>.part[1].corner, path);
    } else {
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
        count_bisected(1);
        const Real uz = field_->template value_at<whole>(z, key);
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
                    ++masked_;
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
void BisectionWalk<Grid, Field, Visitor, whole>::walk_block(
    const Block& above, const std::array<std::uint8_t, 4>& corner, int path) {
    static constexpr const auto& pattern = block_of<Grid>;
    constexpr std::size_t inner = pattern.ends - 2;
    Block block;
    begin_block(block, last_, path);
    for (std::size_t i = 0; i < corners; ++i) {
        block.node[i] = above.node[corner[i]];
        block.key[i] = above.key[corner[i]];
        block.value[i] = above.value[corner[i]];
        if constexpr (in_subtrees_) block.faces[i] = above.faces[corner[i]];
    }
    const auto make_node = [&](std::size_t i) NESTGRID_INLINE_LAMBDA {
        const auto [a, b] = pattern.parent[i];
        block.node[i] = grid_->middle(block.node[a], block.node[b]);
        block.key[i] = grid_->middle_key(block.key[a], block.key[b]);
    };
    static_assert(pattern.part[1].middle == corners);
    static_assert(std::ranges::all_of(pattern.part.begin() + pattern.ends, pattern.part.end(),
                                      [](const auto& end) { return end.bisection == last_; }));
    make_node(corners);
    const auto [lo, hi] = range(block, pattern.part[1].corner);
    const auto [visit, bound] =
        visitor_->glance(lo, hi, grid_->rule(last_), block.key[corners], path / 2, false);
    if (visit == Visit::skip) return;
    if constexpr (in_subtrees_) {
        if (path / 2 == subtree_level_) begin_subtree(block);
    }
    if (visit == Visit::stop) return extract_part(block, 1, bound);
    unrolled<pattern.nodes - corners>([&](auto i) NESTGRID_INLINE_LAMBDA {
        constexpr std::size_t at = corners + i;
        if constexpr (at > corners) make_node(at);
        block.value[at] = field_->template value_at<whole>(block.node[at], block.key[at]);
        if constexpr (in_subtrees_) {
            block.faces[at] =
                block.faces[pattern.parent[at][0]] & block.faces[pattern.parent[at][1]];
        }
    });
    BlockInterior<Real, inner> interior;
    unrolled<inner>([&](auto i) NESTGRID_INLINE_LAMBDA {
        constexpr auto part = pattern.part[i + 2];
        std::tie(interior.lo[i], interior.hi[i]) = range(block, part.corner);
        interior.key[i] = block.key[part.middle];
        interior.rule[i] = &grid_->rule(part.bisection);
        interior.level[i] = path / 2 + part.depth;
    });
    auto glance = visitor_->glance_within(interior);
    const auto& reached = pattern.reached[glance.descend];
    glance.descend &= reached.interior;
    glance.stop &= reached.interior;
    count_bisected(1U + reached.descended);
    constexpr auto first = pattern.part[pattern.ends];
    constexpr KnownBisection next = Grid::bisections[first.bisection];
    const bool leaves = !grid_->halved(block.node[first.corner[next.parent[0]]],
                                       block.node[first.corner[next.parent[1]]]);
    if (leaves && glance.stop == 0) {
        extracted_ += visitor_->extract_block(block, reached.ends);
        return;
    }
    walk_part<2>(block, glance, leaves, path);
    walk_part<3>(block, glance, leaves, path);
}

template <class Grid, class Field, class Visitor, bool whole>
NESTGRID_NOINLINE void BisectionWalk<Grid, Field, Visitor, whole>::begin_subtree(Block& block) {
    for (std::size_t i = 0; i < corners; ++i) {
        block.faces[i] = static_cast<SubtreeFaces>((1U << corners) - 1 - (1U << i));
    }
    visitor_->begin_subtree();
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t p, class Glance>
NESTGRID_INLINE void BisectionWalk<Grid, Field, Visitor, whole>::walk_part(const Block& block,
                                                                           const Glance& glance,
                                                                           bool leaves, int path) {
    static constexpr const auto& pattern = block_of<Grid>;
    static constexpr auto part = pattern.part[p];
    if constexpr (p >= pattern.ends) {
        if (!leaves) {
            walk_block(block, part.corner, (path + 2 * part.depth) ^ (part.mirrored ? 1 : 0));
        } else {
            const auto [lo, hi] = range(block, part.corner);
            if (visitor_->glance_at_leaf(lo, hi)) extract_part(block, p, Real(0));
        }
    } else if ((glance.descend >> (p - 2) & 1U) != 0) {
        walk_part<2 * p>(block, glance, leaves, path);
        walk_part<2 * p + 1>(block, glance, leaves, path);
    } else if ((glance.stop >> (p - 2) & 1U) != 0) {
        extract_part(block, p, glance.bound[p - 2]);
    }
}

template <class Grid, class Field, class Visitor, bool whole>
template <std::size_t number>
NESTGRID_NOINLINE void BisectionWalk<Grid, Field, Visitor, whole>::extract(
    const std::array<Node, 4>& n, const std::array<Real, 4>& u, int path, Real bound) {
    extract_part(make_alone(number, n, u, path), 1, bound);
}

}  // namespace nestgrid
