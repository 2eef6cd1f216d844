// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of bisections (bisection_block.hpp) side by side: a row of numbers for each of their
// nodes, so that one loop does the same for all of them.
#pragma once

#include <algorithm>
#include <utility>

#include <nestgrid/bisection_block.hpp>
#include <nestgrid/pack.hpp>
#include <nestgrid/wide_point.hpp>

namespace nestgrid {

/// Which faces of the subtree a node is in the node lies on, one bit each from bit 0; and, from bit
/// 4, of the element with which the walk of blocks began. An edge whose ends share none is an edge
/// of no element outside it. Above the subtrees all of the lower bits are set, as on no edge in
/// one.
using SubtreeFaces = std::uint8_t;
inline constexpr SubtreeFaces subtree_faces = 0x0F;
inline constexpr SubtreeFaces root_faces = 0xF0;

constexpr bool is_above_subtrees(SubtreeFaces edge) {
    return (edge & subtree_faces) == subtree_faces;
}
constexpr bool is_within_subtree(SubtreeFaces edge) { return (edge & subtree_faces) == 0; }
constexpr bool is_within_root(SubtreeFaces edge) { return (edge & root_faces) == 0; }

/// How many are walked side by side.
inline constexpr std::size_t most_blocks = 32;

/// The least and the greatest of an element's values.
template <class Real>
NESTGRID_INLINE std::pair<Real, Real> range_of(const std::array<Real, 4>& u) {
    return {std::min(std::min(u[0], u[1]), std::min(u[2], u[3])),
            std::max(std::max(u[0], u[1]), std::max(u[2], u[3]))};
}

/// Elements that one rule splits, on one level, eight at once; some may be there several times.
template <class Real>
struct PackedElements {
    const Rule& rule;
    int level;
    const NodeKey* node;  ///< the new node of each
    Pack<Real> lo;
    Pack<Real> hi;  ///< lo ... hi: values at the corners
};

/// What a visitor makes of them.
template <class Real>
struct PackedGlance {
    typename Pack<Real>::Mask descend;
    typename Pack<Real>::Mask stop;  ///< not both
    Pack<Real> bound;                ///< where it stops
};

/// Blocks on one level, in the order of the traversal.
/// \tparam most  room for as many. One alone may be no more than an element that is extracted: then
///         there is nothing but its corners
template <class Grid, class Real, std::size_t most>
struct BlockBatch {
    using Node = typename Grid::Node;
    static constexpr const auto& pattern = block_of<Grid>;
    static constexpr std::size_t room = most;
    template <class T>
    struct alignas(most * sizeof(T) % 64 == 0 ? 64 : alignof(T)) Row : std::array<T, most> {};
    template <class T>
    using Rows = std::array<Row<T>, pattern.nodes>;

    const Grid* grid;
    std::size_t bisection;  ///< number of the one of part 1
    int level;              ///< of part 1
    std::size_t count;
    Rows<Node> nodes;
    Rows<NodeKey> keys;
    Rows<Real> values;  ///< P_S U
    Rows<SubtreeFaces> sides;
    Row<std::uint8_t> orientations;  ///< of part 1: 1 in a mirror

    void begin(const Grid& of, std::size_t number, int on_level) {
        grid = &of;
        bisection = number;
        level = on_level;
        count = 0;
    }
    /// The corners of block b, above the subtrees and in no root.
    void put_corners(std::size_t b, const std::array<Node, 4>& n, const std::array<Real, 4>& u,
                     bool mirror) {
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            nodes[i][b] = n[i];
            keys[i][b] = grid->key(n[i]);
            values[i][b] = u[i];
            sides[i][b] = root_faces | subtree_faces;
        }
        orientations[b] = mirror ? 1 : 0;
    }

    /// Repeats the last block, that rows may be read up to packed(count). There is one.
    NESTGRID_INLINE void fill_up() {
        const std::size_t last = count - 1;
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            for (std::size_t b = count; b < packed(count); ++b) {
                nodes[i][b] = nodes[i][last];
                keys[i][b] = keys[i][last];
                values[i][b] = values[i][last];
            }
        }
    }

    // Of block b.
    NESTGRID_INLINE NodeKey key(std::size_t b, std::size_t node) const { return keys[node][b]; }
    NESTGRID_INLINE Real value(std::size_t b, std::size_t node) const { return values[node][b]; }
    NESTGRID_INLINE SubtreeFaces faces(std::size_t b, std::size_t node) const {
        return sides[node][b];
    }
    NESTGRID_INLINE const Real* row(std::size_t node) const { return values[node].data(); }
    NESTGRID_INLINE bool mirrored(std::size_t b) const { return orientations[b] != 0; }
    NESTGRID_INLINE Point position(std::size_t b, std::size_t node) const {
        return grid->position(nodes[node][b]);
    }
    NESTGRID_INLINE void all_positions(std::size_t b,
                                       std::array<WidePoint, pattern.nodes>& x) const {
        positions_of<pattern.nodes>(b, x, [](std::size_t i) NESTGRID_INLINE_LAMBDA { return i; });
    }
    /// Of the corners of a part.
    NESTGRID_INLINE void corner_positions(std::size_t b, std::size_t part,
                                          std::array<WidePoint, pattern.corners>& x) const {
        positions_of<pattern.corners>(b, x, [&](std::size_t i) NESTGRID_INLINE_LAMBDA {
            return std::size_t{pattern.part[part].corner[i]};
        });
    }
    /// Faces on the boundary of the domain, one bit each.
    unsigned boundary(std::size_t b, std::size_t part) const {
        return grid->boundary_faces(element(b, part));
    }
    ElementOf<Grid> element(std::size_t b, std::size_t part) const {
        const auto& which = pattern.part[part];
        std::array<Node, pattern.corners> of;
        for (std::size_t i = 0; i < of.size(); ++i) of[i] = nodes[which.corner[i]][b];
        return grid->element(part == 1 ? bisection : which.bisection, of);
    }

private:
    template <std::size_t many, class Which>
    NESTGRID_INLINE void positions_of(std::size_t b, std::array<WidePoint, many>& x,
                                      const Which& which) const {
        if constexpr (AnswersInRows<Grid>) {
            std::array<Node, many> of;
            std::array<Point, many> at;
            for (std::size_t i = 0; i < many; ++i) of[i] = nodes[which(i)][b];
            grid->positions(of, at);
            for (std::size_t i = 0; i < many; ++i) x[i] = WidePoint(at[i]);
        } else {
            unrolled<many>([&](auto i) NESTGRID_INLINE_LAMBDA {
                x[i] = WidePoint(grid->position(nodes[which(i)][b]));
            });
        }
    }
};

}  // namespace nestgrid
