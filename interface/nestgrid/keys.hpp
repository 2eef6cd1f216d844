// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Node keys: identity, never coordinates.
//
// Invariants:
//   - a coarse node's key is a function of its id; a new node's key is a function of the keys of
//     its parents and of its stencil, never of floating-point numbers;
//   - the function is symmetric in the parents that have equal weights.
// Consequence: a node has one key in every element, thread and process, without any search, and an
// adapter needs ids on the coarse grid only.
// With n nodes, two get the same 64-bit key with probability n^2 / 2^65: 3e-8 for a million,
// 3e-4 for a hundred million. Configure with -D NESTGRID_WIDE_KEYS=ON for 128 bits beyond that: the
// library and the programs that use it must agree, or they do not link.
#pragma once

#include <cstdint>

#include <nestgrid/rule.hpp>

namespace nestgrid {

/// The key of a node, the same from every element, thread and process; 64 or 128 bits.
#ifdef NESTGRID_WIDE_KEYS
__extension__ using NodeKey = unsigned __int128;
#else
using NodeKey = std::uint64_t;
#endif

namespace detail {

/// Defined in the library for the keys it was compiled with, so that a program with others does not
/// link.
#ifdef NESTGRID_WIDE_KEYS
void library_has_keys_of_128_bits();
[[gnu::used]] inline void (*const same_keys)() = &library_has_keys_of_128_bits;
#else
void library_has_keys_of_64_bits();
[[gnu::used]] inline void (*const same_keys)() = &library_has_keys_of_64_bits;
#endif

/// Finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection with full avalanche.
constexpr std::uint64_t mix64(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ULL;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
    return x ^ (x >> 31U);
}

constexpr NodeKey mix(NodeKey x) {
#ifdef NESTGRID_WIDE_KEYS
    const auto high = static_cast<std::uint64_t>(x >> 64U);
    const auto low = static_cast<std::uint64_t>(x);
    const std::uint64_t h = mix64(high ^ mix64(low));
    return (NodeKey{h} << 64U) | mix64(low + h);
#else
    return mix64(x);
#endif
}

}  // namespace detail

/// The bits a hash table may use to place a key, whether given by an adapter or derived.
constexpr std::uint64_t hash(NodeKey key) {
#ifdef NESTGRID_WIDE_KEYS
    return detail::mix64(static_cast<std::uint64_t>(key) ^
                         detail::mix64(static_cast<std::uint64_t>(key >> 64U)));
#else
    return detail::mix64(key);
#endif
}

/// Key of a node of the coarse grid with the id `id`.
constexpr NodeKey coarse_key(std::uint64_t id) { return detail::mix(id); }

/// Key of the plain mean of `count` nodes whose keys add up to `sum`; `number` tells apart stencils
/// with the same parents and the same order of weights.
constexpr NodeKey mean_key(NodeKey sum, unsigned count, unsigned number = 0) {
    return detail::mix(sum + NodeKey{count} * 0xd1342543de82ef95ULL +
                       NodeKey{number} * 0xaf251af3b0f025b5ULL);
}

/// Key of a new node from the keys of the nodes known so far, the parent's corners first.
constexpr NodeKey derived_key(const Stencil& stencil, const NodeKey* keys) {
    NodeKey sum = 0;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        const NodeKey key = keys[stencil.parent[i]];
        sum += stencil.rank[i] == 0 ? key : detail::mix(key + stencil.rank[i]);
    }
    return mean_key(sum, stencil.count, stencil.number);
}

}  // namespace nestgrid
