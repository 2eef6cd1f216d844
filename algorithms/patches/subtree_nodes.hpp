// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What the walk in patches (patch_walk.hpp) tells about nodes, so that a visitor can name edges
// without keys.
//
// The *root* is the element with which a walk in patches began. A *subtree* is an element that
// begins a patch, and all below it for some levels of patches; subtrees lie in the root. The walk
// tells on which faces of subtree and root a node lies, and gives it a number, such that the sum of
// two numbers tells one edge from another. So a visitor needs a table of keys only for edges that
// elements outside a subtree may have.
//
// Why sums do this: nodes have barycentric coordinates in the subtree, which are integers in units
// of the shortest edge. Edges of a conforming mesh have different midpoints, and the sum of the
// ends of an edge is twice its midpoint. No edge has the sum 0, because the node with the number 0
// is a corner.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <nestgrid/detail/pack.hpp>
#include <patches/bisection_patch.hpp>

namespace nestgrid::engine {

/// The number of patches that are walked side by side, and of subtrees.
inline constexpr std::size_t most_patches = 32;

/// A node: from bit 0 the faces of the subtree that it lies on, one bit each; from bit 4 the faces
/// of the root; from bit 8 its number.
using SubtreeNode = std::uint32_t;

inline constexpr SubtreeNode root_faces = 0xF0U;  ///< the bits of the faces of the root

/// Whether no element outside the root has the edge between two nodes.
constexpr bool is_within_root(SubtreeNode a, SubtreeNode b) { return (a & b & root_faces) == 0; }

/// Computes the numbers and faces of nodes.
/// \tparam pattern the pattern of the patches
template <const auto& pattern>
class SubtreeNodes {
    static constexpr std::size_t dimension_ = pattern.corners - 1;
    static constexpr SubtreeNode faces_ = 0xFFU;
    static constexpr int number_at_ = 8;
    /// The faces that meet in a corner. Face i lies across from corner i.
    static constexpr SubtreeNode faces_at(std::size_t corner) {
        return ((1U << pattern.corners) - 1) & ~(1U << corner);
    }
    /// The common denominator of the barycentric coordinates of the nodes of a patch.
    static constexpr std::uint32_t divisions_ = [] {
        constexpr std::uint32_t whole = 1U << pattern.height;
        std::array<std::array<std::uint32_t, pattern.corners>, pattern.most_nodes> coordinates{};
        std::uint32_t any = whole;  // bits set in any coordinate
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
    /// The number of levels of patches in a subtree. A subtree of three levels of tetrahedra has
    /// 512 leaves, and half of its edges lie inside it.
    static constexpr int height = divisions_ == 2 ? 3 : 1;

private:
    static constexpr std::uint32_t extent_ =
        height == 3 ? divisions_ * divisions_ * divisions_ : divisions_;
    static constexpr std::uint32_t per_direction_ = 2 * extent_ + 1;  // sums of two coordinates
    /// How many numbers the edges of one subtree take; even, because corner 0 of subtree s has the
    /// number s * numbers_ / 2.
    static constexpr std::uint32_t numbers_ = [] {
        std::uint32_t all = 1;
        for (std::size_t i = 0; i < dimension_; ++i) all *= per_direction_;
        return all + all % 2;
    }();

public:
    /// All edges of this many subtrees have smaller numbers.
    static constexpr std::uint32_t edge_numbers(std::size_t subtrees) {
        return static_cast<std::uint32_t>(subtrees) * numbers_;
    }
    /// The number of an edge with an end in no subtree.
    static constexpr std::uint32_t no_number = 0;
    /// The number bits of a node above or below the subtrees.
    static constexpr SubtreeNode beyond = edge_numbers(most_patches) << number_at_;
    /// A node of unknown place: in no subtree, and on all faces, so that elements beyond may have
    /// its edges.
    static constexpr SubtreeNode unknown = beyond | faces_;

    /// The number of the edge between two nodes, or no_number.
    static constexpr std::uint32_t edge_number(SubtreeNode a, SubtreeNode b) {
        const std::uint32_t sum = (a >> number_at_) + (b >> number_at_);
        return sum < edge_numbers(most_patches) ? sum : no_number;
    }
    /// Whether the edge has a number, and no element outside its subtree has the edge.
    static constexpr bool is_inside(SubtreeNode a, SubtreeNode b) {
        return ((a & b & 0x0FU) == 0) & (edge_number(a, b) != no_number);
    }
    /// A corner of the root, above the subtrees.
    static constexpr SubtreeNode root_corner(std::size_t corner) {
        return beyond | faces_at(corner) << 4U | 0x0FU;
    }
    /// A corner of a subtree.
    /// \param of the same node above the subtree
    static constexpr SubtreeNode corner(SubtreeNode of, std::size_t subtree, std::size_t corner) {
        std::uint32_t number = static_cast<std::uint32_t>(subtree) * (numbers_ / 2);
        std::uint32_t step = extent_;
        for (std::size_t i = 1; i < corner; ++i) step *= per_direction_;
        if (corner > 0) number += step;
        return number << number_at_ | (of & root_faces) | faces_at(corner);
    }
    /// The node in the middle of two nodes, in a subtree or above it.
    /// \tparam Nodes SubtreeNode, or a Pack of them
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
    /// The node in the middle of two nodes, below the subtrees, in Packs.
    template <class Nodes>
    NESTGRID_INLINE static Nodes middle_below(const Nodes& a, const Nodes& b) {
        return Nodes::all(beyond) | (a & b & Nodes::all(faces_));
    }
};

}  // namespace nestgrid::engine
