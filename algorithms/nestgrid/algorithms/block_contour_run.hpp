// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of several blocks as two lists without gaps, of cuts and of loops. A loop over the
// cuts of one block ends where no processor predicts it; one over those of many blocks does not.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <nestgrid/algorithms/block_contours.hpp>

namespace nestgrid {

/// \tparam pattern of the blocks
/// \tparam most blocks
template <const auto& pattern, std::size_t most>
class BlockContourRun {
public:
    using Cut = BlockContours::Cut;
    using Loop = BlockContours::Loop;

    /// Edges of a block, any of which may be cut.
    static constexpr std::size_t edges = [] {
        std::array<std::array<bool, 16>, 16> seen{};
        std::size_t count = 0;
        for (std::size_t end = pattern.ends; end < 2 * pattern.ends; ++end) {
            const auto& corner = pattern.part[end].corner;
            for (std::size_t i = 0; i < pattern.corners; ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    const auto [a, b] = std::minmax(corner[i], corner[j]);
                    if (!seen[a][b]) ++count;
                    seen[a][b] = true;
                }
            }
        }
        return count;
    }();
    static constexpr std::size_t most_cuts = most * edges;

    /// \param b number of the block, below `most`; not one that is there already
    NESTGRID_INLINE void append(const BlockContours& contours,
                                const BlockContours::Contour& contour, std::size_t b) {
        constexpr std::size_t cuts = BlockContours::cuts_at_once;
        constexpr std::size_t loops = BlockContours::loops_at_once;
        static_assert(pattern.ends <= loops);
        first_cut_[b] = static_cast<std::uint16_t>(cut_count);
        const auto copy_cuts = [&](std::size_t from) {
            const std::size_t to = cut_count + from;
            std::memcpy(cut_.data() + to, contours.cuts(contour).data() + from, cuts * sizeof(Cut));
            std::memset(block_of_cut_.data() + to, static_cast<int>(b), cuts);
        };
        copy_cuts(0);
        if (edges > cuts && contour.cut_count > cuts) copy_cuts(cuts);
        std::memcpy(loop_.data() + loop_count, contours.loops(contour).data(),
                    loops * sizeof(Loop));
        std::memset(block_of_loop_.data() + loop_count, static_cast<int>(b), loops);
        cut_count += contour.cut_count;
        loop_count += contour.loop_count;
        simplex_count += contour.simplex_count;
    }

    std::size_t cut_count = 0;
    std::size_t loop_count = 0;
    std::size_t simplex_count = 0;

    // Of cut i:
    NESTGRID_INLINE const Cut& cut(std::size_t i) const { return cut_[i]; }
    NESTGRID_INLINE std::size_t block_of_cut(std::size_t i) const { return block_of_cut_[i]; }
    // Of loop i:
    NESTGRID_INLINE const Loop& loop(std::size_t i) const { return loop_[i]; }
    NESTGRID_INLINE std::size_t block_of_loop(std::size_t i) const { return block_of_loop_[i]; }
    /// Its cuts are numbered from this one on.
    NESTGRID_INLINE std::size_t first_cut(std::size_t i) const {
        return first_cut_[block_of_loop_[i]];
    }

private:
    static_assert(edges <= 2 * BlockContours::cuts_at_once);
    static constexpr std::size_t cut_room_ = most_cuts + 2 * BlockContours::cuts_at_once;
    static constexpr std::size_t loop_room_ = most * pattern.ends + BlockContours::loops_at_once;

    // What is behind the last one has no meaning.
    std::array<Cut, cut_room_> cut_;
    std::array<std::uint8_t, cut_room_> block_of_cut_;
    std::array<Loop, loop_room_> loop_;
    std::array<std::uint8_t, loop_room_> block_of_loop_;
    std::array<std::uint16_t, most> first_cut_;
};

}  // namespace nestgrid
