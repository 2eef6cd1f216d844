// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A hash table from pairs of nodes to the numbers of the vertices between them.
//
// The table is flat, takes 16 bytes a slot and is at most five eighths full. A slot names its pair
// by one word: both keys where all keys are below 2^32, else a hash of the keys. Two pairs have the
// same hash as rarely as two nodes have the same derived key (keys.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/detail/key_table.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::engine {

[[noreturn]] inline void throw_too_many_vertices() {
    throw GridError("the surface has 2^32 vertices or more");
}

class VertexNumbers {
public:
    using Number = std::uint32_t;

    /// \param small_keys all keys are below 2^32
    explicit VertexNumbers(bool small_keys = false) : small_keys_{small_keys} {}

    /// The word of a pair and its hash. Tables with the same kind of keys give a pair one name.
    struct Name {
        NodeKey word;
        std::size_t hash;
    };
    NESTGRID_INLINE Name name(const KeyPair& nodes) const {
        const NodeKey word = small_keys_ ? (nodes.low << 32U | nodes.high)
                                         : detail::mix(detail::mix(nodes.low) + nodes.high);
        return {word, hash(word)};
    }

    /// Fetches the slot of a name into the cache.
    NESTGRID_INLINE void prefetch([[maybe_unused]] const Name& name) const {
#if defined(__GNUC__)
        __builtin_prefetch(slots_.data() + (name.hash & mask_));
#endif
    }

    /// The number of the vertex with a name; make() returns it where the vertex is new.
    template <class Make>
    NESTGRID_INLINE Number find(const Name& name, Make&& make) {
        reserve(1);
        Slot* slot = place(name);
        if (slot->round == round_) return slot->number;
        const Number number = make();
        *slot = {name.word, number, round_};
        ++size_;
        return number;
    }

    /// Makes room for `more` vertices.
    NESTGRID_INLINE void reserve(std::size_t more) {
        while (8 * (size_ + more) >= 5 * slots_.size()) grow();
    }
    struct Found {
        Number number;
        bool is_new;
    };
    /// Finds the vertex with a name, or adds it with number `next`, without a branch. Requires
    /// reserve(1).
    /// \param next greater than all numbers in the table
    NESTGRID_INLINE Found find_or_add(const Name& name, Number next) {
        Slot* slot = place(name);
        const bool is_new = slot->round != round_;
        const Number known = slot->number | (is_new ? ~Number{0} : 0U);
        *slot = {name.word, std::min(known, next), round_};
        size_ += is_new ? 1 : 0;
        return {slot->number, is_new};
    }

    /// Empties the table, and keeps its memory.
    void clear() {
        size_ = 0;
        if (++round_ != 0) return;
        for (Slot& slot : slots_) slot.round = 0;
        round_ = 1;
    }

    /// Empties the table, and frees its memory.
    void free_memory() { *this = VertexNumbers(small_keys_); }

    std::size_t memory_bytes() const { return slots_.capacity() * sizeof(Slot); }

private:
    struct Slot {
        NodeKey word = 0;
        Number number = 0;
        std::uint32_t round = 0;  // last round of use; a slot of an earlier round is empty
    };

    NESTGRID_INLINE static std::size_t hash(NodeKey word) {
        auto bits = static_cast<std::uint64_t>(word);
        bits = (bits ^ bits >> 32U) * 0x9e3779b97f4a7c15ULL;
        return static_cast<std::size_t>(bits ^ bits >> 32U);
    }
    NESTGRID_INLINE Slot* place(const Name& name) {
        Slot* const slots = slots_.data();
        std::size_t at = name.hash & mask_;
        while (slots[at].round == round_ && slots[at].word != name.word) at = (at + 1) & mask_;
        return slots + at;
    }

    NESTGRID_NOINLINE void grow() {
        std::vector<Slot> old(slots_.empty() ? std::size_t{1024} : 2 * slots_.size());
        old.swap(slots_);
        mask_ = slots_.size() - 1;
        for (const Slot& slot : old) {
            if (slot.round == round_) *place({slot.word, hash(slot.word)}) = slot;
        }
    }

    std::vector<Slot> slots_;
    std::size_t mask_ = 0;
    std::size_t size_ = 0;
    std::uint32_t round_ = 1;
    bool small_keys_;
};

}  // namespace nestgrid::engine
