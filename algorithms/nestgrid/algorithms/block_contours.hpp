// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of the sign patterns of a block of simplices: those of its ends, one after the other,
// with every cut edge of the block named once.
#pragma once

#include <map>

#include <nestgrid/algorithms/contour_table.hpp>
#include <nestgrid/bisection_block.hpp>

namespace nestgrid {

/// Nodes and cuts are numbered within the block.
class BlockContours {
public:
    struct Cut {
        std::uint8_t low;   ///< node with U < C
        std::uint8_t high;  ///< node with U >= C
    };
    /// A segment, a triangle, or four cuts in a row that may be cut along either diagonal.
    struct Loop {
        std::uint8_t end;  ///< of the block
        std::uint8_t count;
        std::uint8_t mirrored;  ///< that end is, against part 1 of the block
        std::array<std::uint8_t, 4> cut;
    };
    struct Contour {
        std::uint32_t first_cut = 0;
        std::uint32_t first_loop = 0;
        std::uint8_t cut_count = 0;
        std::uint8_t loop_count = 0;
        std::uint16_t ends = 0;  ///< that have a loop, one bit each
    };

    /// The table of a pattern of bisections, made when it is first asked for.
    template <const auto& pattern>
    static const BlockContours& of() {
        static const BlockContours table(pattern);
        return table;
    }

    /// Bit i of `signs` says that node i has U >= C.
    const Contour& at(unsigned signs) const { return contours_[signs]; }
    /// In the order in which the ends come to them.
    std::span<const Cut> cuts(const Contour& c) const {
        return {cuts_.data() + c.first_cut, c.cut_count};
    }
    /// In the order of the ends.
    std::span<const Loop> loops(const Contour& c) const {
        return {loops_.data() + c.first_loop, c.loop_count};
    }

private:
    template <class Pattern>
    explicit BlockContours(const Pattern& pattern);

    std::vector<Contour> contours_;
    std::vector<Cut> cuts_;
    std::vector<Loop> loops_;
};

template <class Pattern>
BlockContours::BlockContours(const Pattern& pattern) {
    const Shape shape = Pattern::corners == 3 ? Shape::triangle : Shape::tetrahedron;
    const ContourTable& table = ContourTable::of(shape);
    for (unsigned signs = 0; signs < 1U << pattern.nodes; ++signs) {
        Contour contour;
        contour.first_cut = static_cast<std::uint32_t>(cuts_.size());
        contour.first_loop = static_cast<std::uint32_t>(loops_.size());
        std::map<std::pair<std::uint8_t, std::uint8_t>, std::uint8_t> number;
        for (std::size_t end = 0; end < Pattern::ends; ++end) {
            const auto& part = pattern.part[Pattern::ends + end];
            unsigned bits = 0;
            for (std::size_t i = 0; i < Pattern::corners; ++i) {
                bits |= (signs >> part.corner[i] & 1U) << i;
            }
            if (bits == 0 || bits + 1 == 1U << Pattern::corners) continue;
            const ContourLoop& from = table.plain(bits)->loop[0];  // of a simplex the only one
            Loop loop{static_cast<std::uint8_t>(end), from.count, part.mirrored, {}};
            for (std::size_t i = 0; i < from.count; ++i) {
                const auto& [a, b] = topology(shape).edge[from.edge[i]];
                const bool falls = (bits >> a & 1U) != 0;
                const std::uint8_t low = part.corner[falls ? b : a];
                const std::uint8_t high = part.corner[falls ? a : b];
                const auto [at, is_new] = number.try_emplace({low, high}, contour.cut_count);
                if (is_new) {
                    cuts_.push_back({low, high});
                    ++contour.cut_count;
                }
                loop.cut[i] = at->second;
            }
            loops_.push_back(loop);
            ++contour.loop_count;
            contour.ends |= static_cast<std::uint16_t>(1U << end);
        }
        contours_.push_back(contour);
    }
}

}  // namespace nestgrid
