// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <levels/level_search.hpp>
#include <patches/block_drawing.hpp>

namespace nestgrid::engine {

/// Takes the counts of a walk in blocks: calls, and elements that are of interest.
class BlockCounts {
public:
    /// Called now and then with the counts so far.
    virtual void tick(std::uint64_t calls, std::uint64_t visited) = 0;
    /// Called at the end with all counts.
    virtual void add(std::uint64_t calls, std::uint64_t visited) = 0;

protected:
    BlockCounts() = default;
    ~BlockCounts() = default;
    BlockCounts(const BlockCounts&) = default;
    BlockCounts& operator=(const BlockCounts&) = default;
    BlockCounts(BlockCounts&&) noexcept = default;
    BlockCounts& operator=(BlockCounts&&) noexcept = default;
};

/// Draws level sets in the bisections below an element, walked in blocks, as the general walk does
/// to the last bit.
template <int dimension, class Real>
void draw_in_blocks(const Walk<Real>& walk, const ElementView<Real>& view,
                    const LevelSearch<Real>& search, const BlockTarget<dimension, Real>& target,
                    BlockCounts& counts);

}  // namespace nestgrid::engine
