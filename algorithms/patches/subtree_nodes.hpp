// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a walk of patches (patch_walk.hpp) tells of nodes in the subtrees it passes through: on
// which of their faces they lie, and a number, such that the sum of two tells one edge from
// another. So who names edges needs a table of keys only for those that elements outside a subtree
// may have.
//
// The corners of a subtree have barycentric coordinates, and so has every node: integers, if its
// edges are measured in the shortest that there can be. Edges of a conforming mesh have different
// midpoints, and twice the midpoint is the sum of the ends. It is 0 for no edge: the node 0 is a
// corner.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <nestgrid/detail/pack.hpp>
#include <patches/bisection_patch.hpp>

namespace nestgrid {

/// How many patches are walked side by side, and so how many subtrees.
inline constexpr std::size_t most_patches = 32;

/// From bit 0 the faces of the subtree the node lies on, one bit each; from bit 4 those of the
/// element with which the walk of patches began; from bit 8 its number.
using SubtreeNode = std::uint32_t;

inline constexpr SubtreeNode root_faces = 0xF0U;  ///< the latter

/// Whether no element outside the root has the edge between two.
constexpr bool is_within_root(SubtreeNode a, SubtreeNode b) { return (a & b & root_faces) == 0; }

/// \tparam pattern of the patches
template <const auto& pattern>
class SubtreeNodes {
    static constexpr std::size_t dimension_ = pattern.corners - 1;
    static constexpr SubtreeNode faces_ = 0xFFU;
    static constexpr int number_at_ = 8;
    /// Face i lies across from corner i.
    static constexpr SubtreeNode faces_at(std::size_t corner) {
        return ((1U << pattern.corners) - 1) & ~(1U << corner);
    }
    /// Into how many parts a patch divides the length of an edge, the shortest one counts.
    static constexpr std::uint32_t divisions_ = [] {
        constexpr std::uint32_t whole = 1U << pattern.height;
        std::array<std::array<std::uint32_t, pattern.corners>, pattern.most_nodes> coordinates{};
        std::uint32_t any = whole;  // of all coordinates the bits
        for (std::size_t n = 0; n < pattern.nodes; ++n) {
            for (std::size_t i = 0; i < pattern.corners; ++i) {
                std::uint32_t& x = coordinates[n][i];
                if (n < pattern.corners) {
                    x = i == n ? whole : 0U;
                } else {
                    const auto& [a, b] = pattern.parent[n];
                    x = (coordinates[a][i] + coordinates[b][i]) / 2;
                }
                any |= x;
            }
        }
        return whole / (any & ~(any - 1));
    }();

public:
    /// How many patches high a subtree is. Three of tetrahedra have 512 leaves, of whose edges half
    /// lie inside.
    static constexpr int height = divisions_ == 2 ? 3 : 1;

private:
    static constexpr std::uint32_t extent_ =
        height == 3 ? divisions_ * divisions_ * divisions_ : divisions_;
    static constexpr std::uint32_t per_direction_ = 2 * extent_ + 1;  // sums of two coordinates
    /// Of the edges of a subtree; even, that a node can have half of it.
    static constexpr std::uint32_t numbers_ = [] {
        std::uint32_t all = 1;
        for (std::size_t i = 0; i < dimension_; ++i) all *= per_direction_;
        return all + all % 2;
    }();

public:
    /// Above those of the edges of as many subtrees.
    static constexpr std::uint32_t edge_numbers(std::size_t subtrees) {
        return static_cast<std::uint32_t>(subtrees) * numbers_;
    }
    /// Of an edge with an end that is in no subtree.
    static constexpr std::uint32_t no_number = 0;
    /// Of nodes above or below the subtrees.
    static constexpr SubtreeNode beyond = edge_numbers(most_patches) << number_at_;
    /// What is in no subtree and in no root.
    static constexpr SubtreeNode unknown = beyond | faces_;

    static constexpr std::uint32_t edge_number(SubtreeNode a, SubtreeNode b) {
        const std::uint32_t sum = (a >> number_at_) + (b >> number_at_);
        return sum < edge_numbers(most_patches) ? sum : no_number;
    }
    /// Whether it has one, and no element outside the subtree has the edge.
    static constexpr bool is_inside(SubtreeNode a, SubtreeNode b) {
        return ((a & b & 0x0FU) == 0) & (edge_number(a, b) != no_number);
    }
    /// A corner of the root, before there are subtrees.
    static constexpr SubtreeNode root_corner(std::size_t corner) {
        return beyond | faces_at(corner) << 4U | 0x0FU;
    }
    /// A corner of one of the subtrees.
    /// \param of what is known of it above
    static constexpr SubtreeNode corner(SubtreeNode of, std::size_t subtree, std::size_t corner) {
        std::uint32_t number = static_cast<std::uint32_t>(subtree) * (numbers_ / 2);
        std::uint32_t step = extent_;
        for (std::size_t i = 1; i < corner; ++i) step *= per_direction_;
        if (corner > 0) number += step;
        return number << number_at_ | (of & root_faces) | faces_at(corner);
    }
    /// The node between two, in a subtree or above it; of a Pack, too.
    template <class Nodes>
    NESTGRID_INLINE static Nodes middle(const Nodes& a, const Nodes& b) {
        const auto all = [](SubtreeNode bits) NESTGRID_INLINE_LAMBDA {
            if constexpr (requires { Nodes::all(bits); }) {
                return Nodes::all(bits);
            } else {
                return bits;
            }
        };
        const Nodes number = all(~faces_);
        return (((a & number) + (b & number)) >> 1) | (a & b & all(faces_));
    }
    /// The same below the subtrees.
    template <class Nodes>
    NESTGRID_INLINE static Nodes middle_below(const Nodes& a, const Nodes& b) {
        return Nodes::all(beyond) | (a & b & Nodes::all(faces_));
    }
};

}  // namespace nestgrid
