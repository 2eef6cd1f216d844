// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Patches of bisections (bisection_patch.hpp) side by side: a row of numbers for each of their
// nodes, so that one loop does the same for all of them; and elements beside them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include <nestgrid/detail/pack.hpp>
#include <patches/batch_cuts.hpp>
#include <patches/bisection_patch.hpp>
#include <patches/patch_glance.hpp>
#include <patches/subtree_nodes.hpp>
#include <surfaces/wide_point.hpp>

namespace nestgrid {

/// Where the nodes of a pattern's patches, and the corners of the elements beside them, are kept in
/// the rows of a batch. What is in a batch has a number: patches have 0 ... most_patches - 1, and
/// the elements those that follow.
template <const auto& pattern>
struct BatchPlaces {
    static constexpr std::size_t patch_rows = pattern.height == 0 ? 0 : pattern.nodes;
    static constexpr std::size_t rows = patch_rows + pattern.corners;
    static constexpr std::size_t count = rows * most_patches;

    static constexpr bool is_patch(std::size_t id) { return id < most_patches; }
    /// Of a node of a patch, or of a corner of an element.
    static constexpr std::size_t of(std::size_t id, std::size_t node) {
        return (node + (is_patch(id) ? 0 : patch_rows)) * most_patches + id % most_patches;
    }
};

/// How many of the lowest sixteen bits are set; there are no others.
template <class Unsigned>
constexpr Unsigned count_bits(Unsigned bits) {
    bits = (bits & 0x5555U) + (bits >> 1U & 0x5555U);
    bits = (bits & 0x3333U) + (bits >> 2U & 0x3333U);
    bits = (bits & 0x0F0FU) + (bits >> 4U & 0x0F0FU);
    return (bits & 0x1FU) + (bits >> 8U);
}

/// Of a batch, what is to be extracted, by number, in the order of the traversal: elements, and of
/// patches the parts that stop and, where these are leaves, the ends that are reached.
struct BatchSelection {
    bool ends_are_leaves = false;
    std::size_t count = 0;
    std::array<std::uint8_t, 2 * most_patches> id;
    // There are no other patches among them.
    std::size_t first_patch = 0;
    std::size_t end_of_patches = 0;

    NESTGRID_INLINE void add(std::size_t number) {
        id[count++] = static_cast<std::uint8_t>(number);
    }
    NESTGRID_INLINE void add_patch(std::size_t b) {
        add(b);
        if (end_of_patches == 0) first_patch = b;
        end_of_patches = b + 1;
    }
    /// Patches first ... end - 1; nothing else yet.
    NESTGRID_INLINE void add_patches(std::size_t first, std::size_t end) {
        static constexpr auto numbers = [] {
            std::array<std::uint8_t, 2 * most_patches> all{};
            for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i);
            return all;
        }();
        std::memcpy(id.data(), numbers.data() + first, most_patches);
        count = end - first;
        first_patch = first;
        end_of_patches = end;
    }
    void clear() {
        count = 0;
        end_of_patches = 0;
    }
};

/// Patches on one level, in the order of the traversal, and elements on any level.
template <class Grid, class Real>
struct PatchBatch {
    using Node = typename Grid::Node;
    static constexpr const auto& pattern = patch_of<Grid>;
    static constexpr std::size_t room = most_patches;
    using Places = BatchPlaces<pattern>;
    template <class T>
    struct alignas(room * sizeof(T) % 64 == 0 ? 64 : alignof(T)) Row : std::array<T, room> {};
    /// Numbers of all places, row by row.
    template <class T>
    struct alignas(64) Rows {
        std::array<T, Places::count> all;

        NESTGRID_INLINE T* operator[](std::size_t row) { return all.data() + row * room; }
        NESTGRID_INLINE const T* operator[](std::size_t row) const {
            return all.data() + row * room;
        }
    };

    const Grid* grid;
    int level;                      ///< of part 1 of the patches
    std::size_t count;              ///< of patches
    std::size_t element_count = 0;  ///< beside them
    Rows<Node> nodes;
    Rows<NodeKey> keys;
    Rows<Real> values;                                ///< P_S U
    Rows<SubtreeNode> in_subtree;                     ///< only where they are asked for
    std::array<std::uint8_t, 2 * room> orientations;  ///< 1 in a mirror; of patches, part 1
    /// Of patches, the ends that are reached, one bit each.
    std::array<std::uint8_t, room> ends;
    /// Of patches, where any stops, the parts that are not entered, from bit 0 on part 2; else 0.
    std::array<std::uint8_t, room> undivided;
    /// Of patches, the parts that stop, from bit 0 on part 2, and what was said of them.
    Row<MaskOf<Real>> stops;
    std::array<Row<Real>, 2 * pattern.ends> bounds;
    /// Of patches, not below the bound of any part that stops; of elements, the bound.
    std::array<Real, 2 * room> greatest_bounds;
    // Of elements:
    std::array<std::uint16_t, room> element_levels;
    std::array<std::uint8_t, room> bisections;

    void begin(const Grid& of, int on_level) {
        grid = &of;
        level = on_level;
        count = 0;
    }
    /// The corners of patch b, or of element b - room, in no subtree and in no root.
    void put_corners(std::size_t b, const std::array<Node, 4>& n, const std::array<Real, 4>& u,
                     bool mirror) {
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            const std::size_t at = Places::of(b, i);
            nodes.all[at] = n[i];
            keys.all[at] = grid->key(n[i]);
            values.all[at] = u[i];
            in_subtree.all[at] = SubtreeNodes<pattern>::unknown;
        }
        orientations[b] = mirror ? 1 : 0;
    }
    /// An element behind the others.
    /// \param bound what is known of U in it beside the values at its corners
    void put_element(std::size_t bisection, const std::array<Node, 4>& n,
                     const std::array<Real, 4>& u, int on_level, bool mirror, Real bound) {
        const std::size_t e = element_count++;
        put_corners(room + e, n, u, mirror);
        set_element(e, bisection, on_level, bound);
    }
    /// A part of a patch of any batch of the grid, in the place of the next element.
    /// \tparam with_keys whether those and what is known of subtrees are wanted
    template <bool with_keys>
    NESTGRID_INLINE void copy_element(const PatchBatch& from, std::size_t b, std::size_t p,
                                      Real bound) {
        const std::size_t e = element_count;
        const auto& part = pattern.part[p];
        unrolled<pattern.corners>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const std::size_t at = Places::of(b, part.corner[i]);
            const std::size_t to = Places::of(room, i) + e;
            nodes.all[to] = from.nodes.all[at];
            values.all[to] = from.values.all[at];
            if constexpr (with_keys) {
                keys.all[to] = from.keys.all[at];
                in_subtree.all[to] = from.in_subtree.all[at];
            }
        });
        orientations[room + e] =
            static_cast<std::uint8_t>(from.orientations[b] ^ (part.mirrored ? 1U : 0U));
        set_element(e, part.bisection, from.level + part.depth, bound);
    }

    /// Repeats the last patch, that rows may be read up to packed(count). There is one.
    NESTGRID_INLINE void fill_up() {
        const std::size_t last = count - 1;
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            for (std::size_t b = count; b < packed(count); ++b) {
                nodes[i][b] = nodes[i][last];
                keys[i][b] = keys[i][last];
                values[i][b] = values[i][last];
                in_subtree[i][b] = in_subtree[i][last];
            }
        }
    }
    /// The same with the values of elements. There is one.
    NESTGRID_INLINE void fill_up_elements() {
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            Real* const row = values[Places::patch_rows + i];
            for (std::size_t e = element_count; e < packed(element_count); ++e) row[e] = row[0];
        }
    }

    /// Of what has a number.
    NESTGRID_INLINE bool mirrored(std::size_t id) const { return orientations[id] != 0; }
    /// Where edges are cut.
    /// \param to as many
    void cuts(std::span<const BatchEdge> edges, double isovalue, WidePoint* to) const {
        cut_edges(*this, edges, isovalue, to);
    }
    Point position(std::size_t place) const { return grid->position(nodes.all[place]); }
    /// A part of a patch, or an element.
    ElementOf<Grid> element(std::size_t id, std::size_t part) const {
        const bool is_patch = Places::is_patch(id);
        std::array<Node, pattern.corners> of;
        for (std::size_t i = 0; i < of.size(); ++i) {
            of[i] = nodes.all[Places::of(id, is_patch ? pattern.part[part].corner[i] : i)];
        }
        return grid->element(is_patch ? pattern.part[part].bisection : bisections[id - room], of);
    }
    /// Faces of it on the boundary of the domain, one bit each.
    unsigned boundary(std::size_t id, std::size_t part) const {
        return grid->boundary_faces(element(id, part));
    }

private:
    NESTGRID_INLINE void set_element(std::size_t e, std::size_t bisection, int on_level,
                                     Real bound) {
        bisections[e] = static_cast<std::uint8_t>(bisection);
        element_levels[e] = static_cast<std::uint16_t>(on_level);
        greatest_bounds[room + e] = bound;
    }
};

}  // namespace nestgrid
