// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Patches (bisection_patch.hpp) side by side, so that one loop does the same for all of them, and
// single elements beside them.
//
// Words:
//   - a *batch* holds up to most_patches patches of one level, in the order of the traversal, and
//     up to as many single elements of any levels;
//   - a *row* holds one number for each patch of a batch, such as the keys of node 4 of all
//     patches, or one for each single element, such as the keys of corner 0 of all elements. A
//     row is most_patches numbers long, a whole number of packs (pack.hpp);
//   - an *id* names what is in a batch: patch b has id b, single element e has id most_patches + e;
//   - a *place* is the index of a node of a patch, or of a corner of a single element, in rows that
//     lie one behind the other.
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

namespace nestgrid::engine {

/// The places of a batch: first all nodes of patches, then the corners of single elements.
template <const auto& pattern>
struct BatchPlaces {
    static constexpr std::size_t patch_rows = pattern.height == 0 ? 0 : pattern.nodes;
    static constexpr std::size_t rows = patch_rows + pattern.corners;
    static constexpr std::size_t count = rows * most_patches;

    static constexpr bool is_patch(std::size_t id) { return id < most_patches; }
    /// The place of a node of a patch, or of a corner of a single element.
    static constexpr std::size_t of(std::size_t id, std::size_t node) {
        return (node + (is_patch(id) ? 0 : patch_rows)) * most_patches + id % most_patches;
    }
};

/// How many bits are set. Requires that all but the lowest sixteen are 0.
template <class Unsigned>
constexpr Unsigned count_bits(Unsigned bits) {
    bits = (bits & 0x5555U) + (bits >> 1U & 0x5555U);
    bits = (bits & 0x3333U) + (bits >> 2U & 0x3333U);
    bits = (bits & 0x0F0FU) + (bits >> 4U & 0x0F0FU);
    return (bits & 0x1FU) + (bits >> 8U);
}

/// What a visitor shall extract from a batch, in the order of the traversal: single elements, and
/// of each patch the parts that stop and, where ends are leaves, the ends that are reached.
struct BatchSelection {
    bool ends_are_leaves = false;
    std::size_t count = 0;
    std::array<std::uint8_t, 2 * most_patches> id;
    // The selected patches are first_patch ... end_of_patches - 1.
    std::size_t first_patch = 0;
    std::size_t end_of_patches = 0;

    /// Selects the single element with this id.
    NESTGRID_INLINE void add(std::size_t number) {
        id[count++] = static_cast<std::uint8_t>(number);
    }
    /// Selects patch b. Requires that it follows the patch selected last.
    NESTGRID_INLINE void add_patch(std::size_t b) {
        add(b);
        if (end_of_patches == 0) first_patch = b;
        end_of_patches = b + 1;
    }
    /// Selects patches first ... end - 1. Requires an empty selection.
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

/// A batch of the patches of a grid.
template <class Grid, class Real>
struct PatchBatch {
    using Node = typename Grid::Node;
    static constexpr const auto& pattern = patch_of<Grid>;
    static constexpr std::size_t room = most_patches;
    using Places = BatchPlaces<pattern>;
    template <class T>
    struct alignas(room * sizeof(T) % 64 == 0 ? 64 : alignof(T)) Row : std::array<T, room> {};
    /// Numbers at all places, row by row.
    template <class T>
    struct alignas(64) Rows {
        std::array<T, Places::count> all;

        NESTGRID_INLINE T* operator[](std::size_t row) { return all.data() + row * room; }
        NESTGRID_INLINE const T* operator[](std::size_t row) const {
            return all.data() + row * room;
        }
    };

    const Grid* grid;
    int level;                      ///< of part 1 of each patch
    std::size_t count;              ///< number of patches
    std::size_t element_count = 0;  ///< number of single elements
    Rows<Node> nodes;
    Rows<NodeKey> keys;
    Rows<Real> values;             ///< P_S U
    Rows<SubtreeNode> in_subtree;  ///< set where the visitor names edges
    /// By id: whether the single element, or part 1 of the patch, is mirrored.
    std::array<std::uint8_t, 2 * room> orientations;
    /// By patch: the set of ends that the walk reaches.
    std::array<std::uint8_t, room> ends;
    /// By patch: the set of inner parts that the walk does not enter; 0 where no inner part stops.
    std::array<std::uint8_t, room> undivided;
    /// By patch: the parts that stop, inner parts and ends; bit i stands for part 2 + i.
    Row<MaskOf<Real>> stops;
    /// By part, for each patch: how far U may leave the range of its corner values in the part.
    std::array<Row<Real>, 2 * pattern.ends> bounds;
    /// By id: at least the bound of each part of the patch that stops; the bound of the element.
    std::array<Real, 2 * room> greatest_bounds;
    // By single element: its level, and the number of the bisection that splits it.
    std::array<std::uint16_t, room> element_levels;
    std::array<std::uint8_t, room> bisections;

    /// Sets grid and level, and empties the list of patches, but not that of single elements.
    void begin(const Grid& of, int on_level) {
        grid = &of;
        level = on_level;
        count = 0;
    }
    /// Sets nodes, keys and values at the corners of the patch or single element with id b. Marks
    /// them as nodes of unknown place in subtree and root.
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
    /// Appends a single element. Requires room for it.
    /// \param bound how far U may leave the range of its corner values in the element
    void put_element(std::size_t bisection, const std::array<Node, 4>& n,
                     const std::array<Real, 4>& u, int on_level, bool mirror, Real bound) {
        const std::size_t e = element_count++;
        put_corners(room + e, n, u, mirror);
        set_element(e, bisection, on_level, bound);
    }
    /// Copies part p of patch b of a batch behind the single elements, without counting it.
    /// \tparam with_keys whether to copy keys and in_subtree, too
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

    /// Repeats the last patch, so that packs may read rows up to packed(count). Requires a patch.
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
    /// Repeats the values of the first single element up to packed(element_count). Requires one.
    NESTGRID_INLINE void fill_up_elements() {
        for (std::size_t i = 0; i < pattern.corners; ++i) {
            Real* const row = values[Places::patch_rows + i];
            for (std::size_t e = element_count; e < packed(element_count); ++e) row[e] = row[0];
        }
    }

    /// Whether the single element with this id, or part 1 of the patch, is mirrored.
    NESTGRID_INLINE bool mirrored(std::size_t id) const { return orientations[id] != 0; }
    /// Sets to[i] to the point at which a level set cuts edges[i].
    /// \param to has room for edges.size() points
    void cuts(std::span<const BatchEdge> edges, const CutLevel& cut, WidePoint* to) const {
        cut_edges(*this, edges, cut, to);
    }
    Point position(std::size_t place) const { return grid->position(nodes.all[place]); }
    /// A part of the patch with this id, or the single element with it, whatever `part` is.
    ElementOf<Grid> element(std::size_t id, std::size_t part) const {
        const bool is_patch = Places::is_patch(id);
        std::array<Node, pattern.corners> of;
        for (std::size_t i = 0; i < of.size(); ++i) {
            of[i] = nodes.all[Places::of(id, is_patch ? pattern.part[part].corner[i] : i)];
        }
        return grid->element(is_patch ? pattern.part[part].bisection : bisections[id - room], of);
    }
    /// The faces of element(id, part) on the boundary of the domain, one bit each.
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

}  // namespace nestgrid::engine
