// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How a visitor decides about parts of patches (bisection_patch.hpp), eight patches at once. It
// gets all parts around one new node together, because it looks up the node only once then.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <nestgrid/detail/pack.hpp>
#include <nestgrid/keys.hpp>
#include <patches/bisection_patch.hpp>
#include <patches/subtree_nodes.hpp>

namespace nestgrid::engine {

/// The least and the greatest of an element's corner values.
/// \tparam Number Real or a Pack
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

/// The least and the greatest corner value of eight elements.
template <class Real>
using PackedRange = std::pair<Pack<Real>, Pack<Real>>;

/// Elements on one level that one rule splits, around eight new nodes. An element may be among them
/// several times.
/// \tparam around number of elements around each new node
template <class Real, std::size_t around = 1>
struct PackedElements {
    const Rule& rule;
    int level;
    const NodeKey* node;                          ///< the eight new nodes
    std::array<PackedRange<Real>, around> range;  ///< range[i]: of element i around each node
};

/// The decision about PackedElements. Elements in neither mask are skipped.
template <class Real, std::size_t around = 1>
struct PackedGlance {
    std::array<typename Pack<Real>::Mask, around> descend;
    std::array<typename Pack<Real>::Mask, around> stop;  ///< disjoint from `descend`
    /// By node, where an element around it stops: how far U may leave its range in the element.
    Pack<Real> bound;
};

/// Eight patches of a batch. Pointers point into rows, and rows lie most_patches numbers apart.
template <class Real>
struct PackedPatches {
    const Rule* const* rule;  ///< the rules, by number of the bisection
    int level;                ///< of part 1
    const Real* values;       ///< row of node 0; those of the other nodes follow
    const NodeKey* keys;      ///< row of the first new node of the parts asked about
    Real* bounds;             ///< row of part 0; see() sets those of the parts asked about
};

/// The decision about some parts of eight patches: bit i of a mask stands for the i-th of them.
template <class Real>
struct PackedSight {
    Pack<MaskOf<Real>> descend;
    Pack<MaskOf<Real>> stop;
    Pack<Real> greatest;  ///< at least the bound of each of these parts that stops
};

/// The parts of a patch that a visitor is asked about.
enum class PatchParts : std::uint8_t {
    inner,  ///< parts 2 ... ends - 1
    ends,
};

/// Asks visitor.glance() about parts of eight patches, whether the walk reaches them or not.
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

}  // namespace nestgrid::engine
