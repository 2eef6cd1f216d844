// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A flat hash table with open addressing and linear probing, at most half full.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <nestgrid/detail/inlining.hpp>
#include <nestgrid/keys.hpp>

namespace nestgrid {

/// Two node keys, in either order: the key of an edge, or of a node met twice.
struct KeyPair {
    NodeKey low;
    NodeKey high;

    KeyPair() = default;
    constexpr KeyPair(NodeKey a, NodeKey b) : low{a < b ? a : b}, high{a < b ? b : a} {}
    constexpr bool operator==(const KeyPair&) const = default;
};

constexpr std::uint64_t hash(const KeyPair& pair) {
    return hash(pair.low * NodeKey{0xd1342543de82ef95ULL} + pair.high);
}

/// Maps keys to values. References stay valid until the next insertion.
template <class Key, class Value>
class KeyTable {
public:
    KeyTable() = default;
    explicit KeyTable(std::size_t expected) { reserve(expected); }

    /// The value of `key` and whether it is new; new ones start as `value`.
    std::pair<Value*, bool> insert(const Key& key, const Value& value) {
        if (2 * (size_ + 1) > slots_.size()) grow();
        Slot& slot = slots_[place(key)];
        if (slot.used) return {&slot.value, false};
        slot = {key, value, true};
        ++size_;
        return {&slot.value, true};
    }

    Value* find(const Key& key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

    const Value* find(const Key& key) const {
        if (slots_.empty()) return nullptr;
        const Slot& slot = slots_[place(key)];
        return slot.used ? &slot.value : nullptr;
    }

    /// It will be asked for soon.
    NESTGRID_INLINE void prefetch([[maybe_unused]] const Key& key) const {
#if defined(__GNUC__)
        if (slots_.empty()) return;
        __builtin_prefetch(slots_.data() +
                           (static_cast<std::size_t>(hash(key)) & (slots_.size() - 1)));
#endif
    }

    template <class Function>
    void for_each(Function&& function) const {
        for (const Slot& slot : slots_) {
            if (slot.used) function(slot.key, slot.value);
        }
    }

    void reserve(std::size_t expected) {
        std::size_t capacity = 64;
        while (capacity < 2 * expected) capacity *= 2;
        if (capacity > slots_.size()) rehash(capacity);
    }

    /// Forgets everything but its memory.
    void clear() {
        for (Slot& slot : slots_) slot.used = false;
        size_ = 0;
    }

    std::size_t size() const { return size_; }
    std::size_t memory_bytes() const { return slots_.capacity() * sizeof(Slot); }

private:
    struct Slot {
        Key key;
        Value value;
        bool used = false;
    };

    std::size_t place(const Key& key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>(hash(key)) & mask;
        while (slots_[at].used && !(slots_[at].key == key)) at = (at + 1) & mask;
        return at;
    }

    void grow() {
        // Twice the memory of a small table costs nothing, and moving its slots less often does.
        const std::size_t factor = slots_.size() < (std::size_t{1} << 14U) ? 4 : 2;
        rehash(slots_.empty() ? 64 : factor * slots_.size());
    }
    void rehash(std::size_t capacity) {
        std::vector<Slot> old(capacity);
        old.swap(slots_);
        for (const Slot& slot : old) {
            if (slot.used) slots_[place(slot.key)] = slot;
        }
    }

    std::vector<Slot> slots_;
    std::size_t size_ = 0;
};

}  // namespace nestgrid
