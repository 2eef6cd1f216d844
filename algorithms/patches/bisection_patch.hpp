// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A *patch*: several bisections in a row as one pattern of nodes and elements. Three of Maubach's
// bisections of a tetrahedron make 8 tetrahedra with 10 nodes, two of a triangle make 4 triangles
// with 6 nodes.
//
// Words:
//   - a *part* is an element of a patch. Part 1 is the element that the patch begins with, parts 2i
//     and 2i + 1 are the children of part i;
//   - an *end* is a part on the last level: end i is part 2^height + i. Each end begins a patch of
//     the next level, or is a leaf;
//   - *inner parts* are parts 2 ... 2^height - 1, neither part 1 nor ends;
//   - a *set of inner parts* is a number whose bit i stands for part 2 + i, a *set of ends* one
//     whose bit i stands for end i.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>

#include <patches/known_bisection.hpp>

namespace nestgrid::engine {

/// The parts and the nodes of a patch. Nodes are numbered: first the corners of part 1, then the
/// new nodes of parts 1 ... ends - 1, then the new nodes of the ends.
template <std::size_t corner_count, std::size_t patch_height>
struct BisectionPatch {
    static constexpr std::size_t corners = corner_count;
    static constexpr std::size_t height = patch_height;
    static_assert(height == 0 || height == 2 || height == 3);
    static constexpr std::size_t ends = std::size_t{1} << height;
    static constexpr std::size_t most_nodes = corners + ends - 1;

    struct Part {
        std::array<std::uint8_t, 4> corner{};  ///< nodes; a triangle repeats its last one
        std::uint8_t bisection = 0;            ///< number of the bisection that splits the part
        std::uint8_t middle = 0;               ///< the new node of this bisection
        std::uint8_t depth = 0;                ///< levels below part 1
        bool mirrored = false;                 ///< whether it is a mirror image relative to part 1

        friend constexpr bool operator==(const Part&, const Part&) = default;
    };

    /// What a traversal visits if it enters part 1 and exactly this set of inner parts.
    struct Reached {
        std::uint8_t interior = 0;   ///< the set of inner parts that it reaches
        std::uint8_t ends = 0;       ///< the set of ends that it reaches
        std::uint8_t descended = 0;  ///< number of inner parts that it reaches and enters

        friend constexpr bool operator==(const Reached&, const Reached&) = default;
    };

    /// Number of sets of inner parts.
    static constexpr std::size_t part_sets = std::size_t{1} << (height == 0 ? 0 : ends - 2);

    std::array<Part, 2 * ends> part{};
    std::array<Reached, part_sets> reached{};  ///< by the set of inner parts that are entered
    /// By set of inner parts: the set that holds the first end in each of these parts.
    std::array<std::uint8_t, part_sets> first_ends{};
    std::size_t nodes = corners;      ///< number of nodes without the new nodes of the ends
    std::size_t all_nodes = corners;  ///< number of all nodes
    /// The two nodes in whose middle a node lies; not set for the corners of part 1.
    std::array<std::array<std::uint8_t, 2>, most_nodes + ends> parent{};

    /// \param of number of the bisection that splits part 1
    template <std::size_t count>
    constexpr BisectionPatch(const std::array<KnownBisection, count>& bisections, std::size_t of) {
        for (std::size_t i = 0; i < 4; ++i) {
            part[1].corner[i] = static_cast<std::uint8_t>(std::min(i, corners - 1));
        }
        part[1].bisection = static_cast<std::uint8_t>(of);
        const auto split = [&](Part& p) {
            const KnownBisection& rule = bisections[p.bisection];
            p.middle = node_between(p.corner[rule.parent[0]], p.corner[rule.parent[1]]);
        };
        for (std::size_t p = 1; p < ends; ++p) {
            split(part[p]);
            for (std::size_t c = 0; c < 2; ++c) {
                const KnownBisection::Half& half = bisections[part[p].bisection].child[c];
                Part& child = part[2 * p + c];
                for (std::size_t i = 0; i < 4; ++i) {
                    const std::uint8_t from = half.corner[std::min(i, corners - 1)];
                    child.corner[i] = from == 4 ? part[p].middle : part[p].corner[from];
                }
                child.bisection = half.bisection;
                child.depth = static_cast<std::uint8_t>(part[p].depth + 1);
                child.mirrored = part[p].mirrored != (half.orientation < 0);
            }
        }
        nodes = all_nodes;
        for (std::size_t p = ends; height > 0 && p < part.size(); ++p) split(part[p]);
        for (unsigned entered = 0; height > 0 && entered < reached.size(); ++entered) {
            unsigned parts = 4U | 8U;  // bit p stands for part p
            for (std::size_t p = 2; p < ends; ++p) {
                if ((parts >> p & entered >> (p - 2) & 1U) == 0) continue;
                parts |= 3U << (2 * p);
                ++reached[entered].descended;
            }
            const unsigned those = (1U << ends) - 1;
            reached[entered].interior = static_cast<std::uint8_t>((parts & those) >> 2U);
            reached[entered].ends = static_cast<std::uint8_t>(parts >> ends);
            for (std::size_t p = 2; p < ends; ++p) {
                if ((entered >> (p - 2) & 1U) == 0) continue;
                first_ends[entered] |= static_cast<std::uint8_t>(1U << first_end(p));
            }
        }
    }

    friend constexpr bool operator==(const BisectionPatch&, const BisectionPatch&) = default;

    /// The largest part of a set in which an end lies, or the part that is the end where there is
    /// none.
    /// \param set a set of inner parts
    static constexpr std::size_t part_above(std::size_t end, unsigned set) {
        for (std::size_t depth = height - 1; depth > 0; --depth) {
            const std::size_t p = (ends + end) >> depth;
            if ((set >> (p - 2) & 1U) != 0) return p;
        }
        return ends + end;
    }
    /// The first end that lies in part p.
    constexpr std::size_t first_end(std::size_t p) const {
        return (p << (height - part[p].depth)) - ends;
    }

private:
    /// The node in the middle of nodes a and b; adds it where it is new.
    constexpr std::uint8_t node_between(std::uint8_t a, std::uint8_t b) {
        for (std::size_t n = corners; n < all_nodes; ++n) {
            if ((parent[n][0] == a && parent[n][1] == b) ||
                (parent[n][0] == b && parent[n][1] == a)) {
                return static_cast<std::uint8_t>(n);
            }
        }
        parent[all_nodes] = {a, b};
        return static_cast<std::uint8_t>(all_nodes++);
    }
};

/// The patch that a grid declares (known_bisection.hpp): the bisection of its ends is that of part
/// 1. A patch of height 0, which is a single element, where the grid declares none.
template <class Grid>
inline constexpr auto patch_of = [] {
    constexpr std::size_t height = [] {
        if constexpr (KnowsPatches<Grid>) return std::size_t{Grid::patch_height};
        return std::size_t{0};
    }();
    return BisectionPatch<static_cast<std::size_t>(Grid::dimension) + 1, height>(
        Grid::bisections, Grid::bisections.size() - 1);
}();

/// Some parts of a patch in the order of the traversal.
template <std::size_t ends>
struct PatchOrder {
    std::array<std::uint8_t, ends> part{};
    std::uint8_t count = 0;
};

/// The inner parts that stop and the ends that are reached, in order. The index holds the set of
/// the inner parts that are entered and, shifted by ends - 2, the set of those that stop. Requires
/// that the traversal reaches all parts of both sets.
template <const auto& pattern>
inline constexpr auto patch_orders = [] {
    constexpr std::size_t ends = pattern.ends;
    constexpr std::size_t bits = ends - 2;
    std::array<PatchOrder<ends>, std::size_t{1} << 2 * bits> result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
        const auto is_set = [&](std::size_t part, std::size_t from) {
            return part < ends && (i >> (part - 2 + from) & 1U) != 0;
        };
        for (std::size_t end = 0; end < ends; ++end) {
            // A part is listed once, when the loop meets its first end.
            const auto entered = static_cast<unsigned>(i % (std::size_t{1} << bits));
            const std::size_t part = pattern.part_above(end, ~entered);
            if (part < ends && (!is_set(part, bits) || end != pattern.first_end(part))) continue;
            result[i].part[result[i].count++] = static_cast<std::uint8_t>(part);
        }
    }
    return result;
}();

/// The ends of a set, in order; the index is the set.
template <const auto& pattern>
inline constexpr auto end_orders = [] {
    constexpr std::size_t ends = pattern.ends;
    std::array<PatchOrder<ends>, std::size_t{1} << ends> result{};
    for (std::size_t i = 0; i < result.size(); ++i) {
        for (std::size_t end = 0; end < ends; ++end) {
            if ((i >> end & 1U) == 0) continue;
            result[i].part[result[i].count++] = static_cast<std::uint8_t>(ends + end);
        }
    }
    return result;
}();

/// The parts whose new node is `node`, ascending.
template <const auto& pattern, std::size_t node>
inline constexpr auto parts_around = [] {
    constexpr auto is_around = [](const auto& part) { return part.middle == node; };
    constexpr auto& all = pattern.part;
    std::array<std::uint8_t, std::size_t(std::count_if(all.begin() + 1, all.end(), is_around))>
        result{};
    for (std::size_t p = 1, count = 0; p < all.size(); ++p) {
        if (is_around(all[p])) result[count++] = static_cast<std::uint8_t>(p);
    }
    return result;
}();

/// The patch of Maubach's bisections that begins with an element of tag `dim`.
template <int dim>
inline constexpr auto maubach_patch =
    BisectionPatch<static_cast<std::size_t>(dim) + 1, static_cast<std::size_t>(dim)>(
        maubach_bisections<dim>(), static_cast<std::size_t>(dim) - 1);

template <class A, class B>
constexpr bool is_same(const A& a, const B& b) {
    if constexpr (std::is_same_v<A, B>) return a == b;
    return false;
}
/// A grid whose patches are those of Maubach's bisections.
template <class Grid>
concept HasMaubachPatches = KnowsPatches<Grid> &&
    is_same(patch_of<Grid>, maubach_patch<Grid::dimension>);

}  // namespace nestgrid::engine
