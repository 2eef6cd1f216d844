// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A flat hash table with open addressing and linear probing, at most half full.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

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
    return detail::mix64(hash(pair.low) ^ (static_cast<std::uint64_t>(pair.high) << 1U));
}

/// Maps keys to values. References stay valid until the next insertion.
template <class Key, class Value>
class KeyTable {
public:
    KeyTable() = default;
    explicit KeyTable(std::size_t expected) { reserve(expected); }

    /// The value of `key` and whether it is new; new ones start as `value`.
    std::pair<Value*, bool> insert(const Key& key, const Value& value) {
        if (2 * (size_ + 1) > slots_.size()) rehash(slots_.empty() ? 64 : 2 * slots_.size());
        const std::size_t at = place(key);
        if (used_[at]) return {&slots_[at].second, false};
        used_[at] = true;
        slots_[at] = {key, value};
        ++size_;
        return {&slots_[at].second, true};
    }

    Value* find(const Key& key) { return const_cast<Value*>(std::as_const(*this).find(key)); }

    const Value* find(const Key& key) const {
        if (slots_.empty()) return nullptr;
        const std::size_t at = place(key);
        return used_[at] ? &slots_[at].second : nullptr;
    }

    template <class Function>
    void for_each(Function&& function) const {
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            if (used_[i]) function(slots_[i].first, slots_[i].second);
        }
    }

    void reserve(std::size_t expected) {
        std::size_t capacity = 64;
        while (capacity < 2 * expected) capacity *= 2;
        if (capacity > slots_.size()) rehash(capacity);
    }

    std::size_t size() const { return size_; }
    std::size_t memory_bytes() const {
        return slots_.capacity() * sizeof(slots_[0]) + used_.capacity() / 8;
    }

private:
    std::size_t place(const Key& key) const {
        const std::size_t mask = slots_.size() - 1;
        std::size_t at = static_cast<std::size_t>(hash(key)) & mask;
        while (used_[at] && !(slots_[at].first == key)) at = (at + 1) & mask;
        return at;
    }

    void rehash(std::size_t capacity) {
        std::vector<std::pair<Key, Value>> old(capacity);
        std::vector<bool> was_used(capacity, false);
        old.swap(slots_);
        was_used.swap(used_);
        for (std::size_t i = 0; i < old.size(); ++i) {
            if (!was_used[i]) continue;
            const std::size_t at = place(old[i].first);
            used_[at] = true;
            slots_[at] = old[i];
        }
    }

    std::vector<std::pair<Key, Value>> slots_;
    std::vector<bool> used_;
    std::size_t size_ = 0;
};

}  // namespace nestgrid
