// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The optional operations of a grid. The library finds and calls them by detail/operations.hpp.
//
// A grid may also offer, always with or without a trailing `Context&`:
//     void corner_keys(e, std::span<NodeKey> out), void new_keys(e, std::span<NodeKey> out)
//         own level-independent node keys; default: derived, keys.hpp
//     std::size_t node_count()
//         promises that own keys lie in [0, node_count): tables become arrays
//     void corner_positions(e, std::span<Point> out)
//         positions by heart, on grids where eq. (1) holds for them; a function of the node alone;
//         default: interpolated on the way down
//     void new_positions(e, NodeMask which, std::span<Point> out)
//         true positions on curved or moving grids; projected with the same S as the data
//     NodeMask constrained(e)
//         new nodes of e that hang, here or in any other element; default: derived
//     std::array<NodeKey, 2> hanging_parents(NodeKey node)
//         with own keys, random access: the ends of the edge, or part of an edge, of a leaf in
//         whose middle the node hangs; `node` twice where it hangs on no edge. Where refinement is
//         anisotropic, an element that makes the node may know other parents; without this
//         operation such grids are refused
//     bool conforming()
//         promises that no node hangs, which spares the derivation
//     bool masked(e)
//         e lies outside the domain: skipped with everything below it; its nodes have values yet
//     Hidden hidden(e)
//         whether e and what lies below it is shown. Nothing depends on values at nodes of hidden
//         leaves alone: they are interpolated, on the coarse grid 0. No element that is hidden in
//         part stops, and hidden leaves constrain no node
//     Presence presence(e)
//         which leaves below e this process has, where the grid is distributed; default: all. What
//         lies below an element that is elsewhere is never asked for. No leaf is here in part
//     NodeMask outside(e)
//         new nodes at which no element may stop because only deeper elements end at the boundary
//         of the domain; saturated like an infinite indicator
//     unsigned boundary_faces(e)
//         faces on the boundary of the domain, one bit each, any of them for an element that
//         reaches across it; default: derived from coarse ids
//     void for_each_star_row(f)
//         calls f(StarRow) fine to coarse, each node of any element in one row that does not
//         gather. All coarse elements are split alike, and all of their children; default: sweeps
//     bool knows_stars()
//         whether it does, where that is decided at run time; of a field, whether it has
//         row_values()
//     Point node_position(NodeKey)
//         random access, with for_each_star_row; splits with the same offsets in key are congruent
//     int geometry_degree(leaf)
//         of the polynomials that are the coordinates of points in the leaf, as degree() of a
//         field; 1: its corners say all
//     void map(leaf, std::span<const Point> reference, std::span<Point> out)
//         where points of the reference element are. With geometry_degree(), neither without the
//         other; asked of leaves only. At a corner it is the position of the node
//     std::uint64_t epoch()
//         changes with the grid: tells stale prerolls
// It may also name constants, from which the sizes of arrays and the lengths of loops follow:
//     static constexpr int max_corners, max_children
//         of its elements and rules; default: those of all shapes and rules
//     static constexpr Shape only_shape
//         of all elements; default: simplices where there are no more corners, else any
// and a field
//     void corner_gradients(e, std::span<Point> out)   gradients at the corners, per unit length
//     void row_values(NodeKey first, std::size_t stride, std::span<value_type> out)
//         at the nodes first, first + stride, ... of a star row or of their parents in one place;
//         random access, with for_each_star_row
//     int degree(leaf)
//         of the polynomials of the leaf, 1 to 8: in each direction on segments, quadrilaterals and
//         hexahedra, in all on simplices, in the triangle and along the segment on prisms, in each
//         of x/(1-z), y/(1-z), z on pyramids. 1: the values at its corners say all
//     void evaluate(leaf, std::span<const Point> reference, std::span<value_type> out)
//         the field itself, all components, at points of the reference element (shape.hpp):
//         component c of point n at out[n * components + c]. With degree(), neither without the
//         other; asked of leaves only. At a corner that does not hang it is the value of the node
// A member with one of these names and another signature does not compile; check_grid lists the
// operations it found.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <nestgrid/grid.hpp>
#include <nestgrid/keys.hpp>

namespace nestgrid {

/// Nodes first, first + stride, ... of a grid with dense keys, each a plain mean of its parents and
/// with finer nodes around it, at the same distances in key from each. A maximum over those and, of
/// each of them, over its own, is one over all nodes that are made in elements with this corner.
struct StarRow {
    std::size_t first = 0;
    std::size_t stride = 1;
    std::size_t count = 0;
    /// None on the coarse grid, 2, 4 around a face in tensor order, or 8.
    std::span<const std::ptrdiff_t> parents;
    std::span<const std::ptrdiff_t> finer;  ///< nodes of earlier rows
    std::size_t outside = 0;  ///< of the last ones: how many are as the operation `outside` says
    /// Nodes inside elements (Rule::inside) that were in earlier rows; `finer` are now all new
    /// nodes of such an element, and these stand for all of them from here on.
    bool gathers = false;
};

/// An optional operation that a grid or field offers.
enum class Feature : unsigned {
    own_keys = 1,
    dense_keys = 2,
    own_positions = 4,
    new_positions = 8,
    constrained = 16,
    masked = 32,
    outside = 64,
    boundary_faces = 128,
    gradients = 256,
    hidden = 512,
    hanging_parents = 1024,
    presence = 2048,
    degree = 4096,
    geometry_degree = 8192,
};
inline constexpr Feature last_feature = Feature::geometry_degree;
/// The greatest degree that a leaf may have.
inline constexpr int max_degree = 8;

/// Whether an element is drawn.
enum class Hidden : std::uint8_t { not_at_all, partly, wholly };

/// Which leaves below an element this process has.
enum class Presence : std::uint8_t {
    here,          ///< all
    partly_first,  ///< some, among them the first one in the order of children
    partly,        ///< some, but not the first one
    elsewhere,     ///< none
};

}  // namespace nestgrid
