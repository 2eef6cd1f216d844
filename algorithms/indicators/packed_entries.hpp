// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Looks up entries of a hierarchical indicator, several at once.
#pragma once

#include <bit>
#include <cstring>
#include <span>

#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/detail/pack.hpp>

namespace nestgrid::engine {

/// Both numbers of an entry in one word: `stop` in its lower half, `bound` in the upper one.
NESTGRID_INLINE std::uint32_t bits_of(const detail::IndicatorEntry& entry) {
    if constexpr (std::endian::native == std::endian::little) {
        std::uint32_t both;
        static_assert(sizeof(entry) == sizeof(both));
        std::memcpy(&both, &entry, sizeof both);
        return both;
    } else {
        return entry.stop | std::uint32_t{entry.bound} << 16U;
    }
}

/// The entry with these bits_of().
NESTGRID_INLINE detail::IndicatorEntry entry_of(std::uint32_t bits) {
    return {static_cast<std::uint16_t>(bits), static_cast<std::uint16_t>(bits >> 16U)};
}

/// Stop and bound of eight nodes.
class PackedEntries {
public:
    /// \param bits bits_of() the entries
    NESTGRID_INLINE explicit PackedEntries(const Pack<std::uint32_t>& bits) : bits_{bits} {}
    NESTGRID_INLINE Pack<float> stop() const { return (bits_ << 16).as<float>(); }
    NESTGRID_INLINE Pack<float> bound() const {
        return (bits_ & Pack<std::uint32_t>::all(0xFFFF0000U)).as<float>();
    }

private:
    Pack<std::uint32_t> bits_;
};

NESTGRID_NOINLINE inline PackedEntries look_up_sparse(const detail::IndicatorEntries& entries,
                                                      const NodeKey* nodes) {
    return PackedEntries(Pack<std::uint32_t>::make(
        [&](auto i) NESTGRID_INLINE_LAMBDA { return bits_of(entries.at_sparse(nodes[i])); }));
}

/// The entries of eight nodes.
NESTGRID_INLINE PackedEntries look_up(const detail::IndicatorEntries& entries,
                                      const NodeKey* nodes) {
    if (entries.dense != nullptr) {
        const detail::IndicatorEntry* const entry = entries.dense.get();
        return PackedEntries(Pack<std::uint32_t>::make([&](auto i) NESTGRID_INLINE_LAMBDA {
            return bits_of(entry[static_cast<std::size_t>(nodes[i])]);
        }));
    }
    return look_up_sparse(entries, nodes);
}

/// Fetches the entries of some nodes into the cache.
NESTGRID_INLINE void prefetch([[maybe_unused]] const detail::IndicatorEntries& entries,
                              [[maybe_unused]] std::span<const NodeKey> nodes) {
#if defined(__GNUC__)
    if (entries.dense == nullptr) {
        for (const NodeKey node : nodes) entries.sparse.prefetch(node);
    } else {
        for (const NodeKey node : nodes) {
            __builtin_prefetch(entries.dense.get() + static_cast<std::size_t>(node));
        }
    }
#endif
}

/// Fetches the entries of the new nodes that a decision about a split reads.
NESTGRID_INLINE void prefetch(const detail::IndicatorEntries& entries, const Rule& rule,
                              std::span<const NodeKey> nodes) {
    prefetch(entries, rule.inside == no_new_node ? nodes : nodes.subspan(rule.inside, 1));
}

}  // namespace nestgrid::engine
