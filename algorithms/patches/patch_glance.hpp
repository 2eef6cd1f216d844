// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a visitor makes of the parts of patches (bisection_patch.hpp), eight patches at once: those
// around one new node together, for what is known of the node is asked for once.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <nestgrid/detail/pack.hpp>
#include <nestgrid/keys.hpp>
#include <patches/bisection_patch.hpp>
#include <patches/subtree_nodes.hpp>

namespace nestgrid {

/// The least and the greatest of an element's values.
/// \tparam Number Real, or several at once
template <class Number>
NESTGRID_INLINE std::pair<Number, Number> range_of(const Number& a, const Number& b,
                                                   const Number& c, const Number& d) {
    using std::max;
    using std::min;
    return {min(min(a, b), min(c, d)), max(max(a, b), max(c, d))};
}
template <class Real>
NESTGRID_INLINE std::pair<Real, Real> range_of(const std::array<Real, 4>& u) {
    return range_of(u[0], u[1], u[2], u[3]);
}

/// The least and the greatest value at the corners of elements.
template <class Real>
using PackedRange = std::pair<Pack<Real>, Pack<Real>>;

/// Elements that one rule splits, on one level, eight at once; some may be there several times.
/// \tparam around how many lie around each new node
template <class Real, std::size_t around = 1>
struct PackedElements {
    const Rule& rule;
    int level;
    const NodeKey* node;  ///< new nodes
    std::array<PackedRange<Real>, around> range;
};

/// What a visitor makes of them.
template <class Real, std::size_t around = 1>
struct PackedGlance {
    std::array<typename Pack<Real>::Mask, around> descend;
    std::array<typename Pack<Real>::Mask, around> stop;  ///< not both
    Pack<Real> bound;                                    ///< where any of them stops
};

/// Eight patches of a batch, in rows that are most_patches apart.
template <class Real>
struct PackedPatches {
    const Rule* const* rule;  ///< by number of the bisection
    int level;                ///< of part 1
    const Real* values;       ///< of node 0, and so on
    const NodeKey* keys;      ///< of the first one of the nodes that are new in the parts
    Real* bounds;             ///< of part 0, and so on; set for the parts that are looked at
};

/// What is seen of some parts of eight patches: bit i of each for the i-th of them.
template <class Real>
struct PackedSight {
    Pack<MaskOf<Real>> descend;
    Pack<MaskOf<Real>> stop;
    Pack<Real> greatest;  ///< bound where any stops
};

/// Which parts of patches.
enum class PatchParts : std::uint8_t {
    inner,  ///< from part 2 on, those that are no ends
    ends,
};

/// What a visitor makes of parts of eight patches, reached or not.
template <const auto& pattern, PatchParts which, class Real, class Visitor>
NESTGRID_INLINE PackedSight<Real> see(const PackedPatches<Real>& patches, Visitor& visitor) {
    using Bits = Pack<MaskOf<Real>>;
    constexpr bool ends = which == PatchParts::ends;
    constexpr std::size_t first_node = ends ? pattern.nodes : pattern.corners + 1;
    constexpr std::size_t nodes = (ends ? pattern.all_nodes : pattern.nodes) - first_node;
    constexpr std::size_t first_part = ends ? pattern.ends : 2;
    PackedSight<Real> seen{Bits::all(0), Bits::all(0), Pack<Real>::all(0)};
    unrolled<nodes>([&](auto n) NESTGRID_INLINE_LAMBDA {
        constexpr const auto& parts = parts_around<pattern, first_node + n>;
        constexpr auto one = pattern.part[parts[0]];
        PackedElements<Real, parts.size()> elements{*patches.rule[one.bisection],
                                                    patches.level + one.depth,
                                                    patches.keys + n * most_patches,
                                                    {}};
        unrolled<parts.size()>([&](auto i) NESTGRID_INLINE_LAMBDA {
            constexpr auto part = pattern.part[parts[i]];
            static_assert(part.depth == one.depth && part.bisection == one.bisection);
            const auto value = [&](std::size_t corner) NESTGRID_INLINE_LAMBDA {
                return Pack<Real>::load(patches.values + part.corner[corner] * most_patches);
            };
            elements.range[i] = range_of(value(0), value(1), value(2), value(3));
        });
        const PackedGlance<Real, parts.size()> glance = visitor.glance(elements);
        unrolled<parts.size()>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const auto bit = Bits::all(MaskOf<Real>{1} << (parts[i] - first_part));
            seen.descend = seen.descend | (glance.descend[i] & bit);
            seen.stop = seen.stop | (glance.stop[i] & bit);
            seen.greatest = max(
                seen.greatest,
                (glance.bound.template as<MaskOf<Real>>() & glance.stop[i]).template as<Real>());
            glance.bound.store(patches.bounds + parts[i] * most_patches);
        });
    });
    return seen;
}

}  // namespace nestgrid
