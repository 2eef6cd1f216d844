// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Bits that tell most keys that are not in a table, without a look into it: the bits stay in the
// cache where the table does not.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nestgrid {

class KeyFilter {
public:
    /// Empties it and makes room for so many keys: 16 bits for each at least.
    void reset(std::size_t keys) {
        words_.assign(std::bit_ceil(std::max<std::size_t>(keys / 4, 16)), 0);
    }

    /// \param hash of the key, all 64 bits of it mixed
    void add(std::uint64_t hash) { words_[place(hash)] |= bit(hash); }

    /// False only where the key was not added.
    bool perhaps(std::uint64_t hash) const { return (words_[place(hash)] & bit(hash)) != 0; }

    std::size_t memory_bytes() const { return words_.capacity() * sizeof(words_[0]); }

private:
    std::size_t place(std::uint64_t hash) const { return hash >> 32U & (words_.size() - 1); }
    static std::uint64_t bit(std::uint64_t hash) { return std::uint64_t{1} << (hash >> 26U & 63U); }

    std::vector<std::uint64_t> words_;
};

}  // namespace nestgrid
