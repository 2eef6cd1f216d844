// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of the sign patterns of a block of simplices: those of its ends, one after the other,
// with every cut edge of the block named once.
#pragma once

#include <nestgrid/algorithms/contour_table.hpp>
#include <nestgrid/bisection_block.hpp>

namespace nestgrid {

/// Nodes and cuts are numbered within the block.
class BlockContours {
public:
    /// As many cuts and loops may be read from the first one of a contour on.
    static constexpr std::size_t cuts_at_once = 16;
    static constexpr std::size_t loops_at_once = 8;

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
    /// The one loop of one element, whose corners take the place of nodes.
    struct Piece {
        std::uint8_t count = 0;
        std::array<Cut, 4> cut{};
        std::array<std::uint8_t, 4> face{};  ///< of the element, behind a cut; contour_table.hpp
    };
    struct Contour {
        std::uint32_t first_cut = 0;
        std::uint32_t first_loop = 0;
        std::uint8_t cut_count = 0;
        std::uint8_t loop_count = 0;
        std::uint8_t simplex_count = 0;
        std::uint8_t ends = 0;  ///< that have a loop, one bit each
    };

    /// The table of a pattern of bisections, made when it is first asked for.
    template <const auto& pattern>
    static const BlockContours& of() {
        static const BlockContours table(pattern);
        return table;
    }

    /// Of an element alone. Bit i of `signs` says that its corner i has U >= C.
    const Piece& piece(unsigned signs) const { return pieces_[signs]; }
    /// Of all ends. Bit i of `signs` says that node i has U >= C.
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

    static Piece make_piece(Shape shape, unsigned signs);

    std::array<Piece, 16> pieces_;
    std::vector<Contour> contours_;
    std::vector<Cut> cuts_;
    std::vector<Loop> loops_;
};

template <class Pattern>
BlockContours::BlockContours(const Pattern& pattern) {
    const Shape shape = Pattern::corners == 3 ? Shape::triangle : Shape::tetrahedron;
    constexpr unsigned all = (1U << Pattern::corners) - 1;
    for (unsigned bits = 1; bits < all; ++bits) pieces_[bits] = make_piece(shape, bits);
    const auto count = std::size_t{1} << pattern.nodes;
    contours_.reserve(count);
    cuts_.reserve(13 * count);
    loops_.reserve(7 * count);
    for (unsigned signs = 0; signs < count; ++signs) {
        Contour contour;
        contour.first_cut = static_cast<std::uint32_t>(cuts_.size());
        contour.first_loop = static_cast<std::uint32_t>(loops_.size());
        std::array<std::array<std::uint8_t, 16>, 16> number{};  // of a cut, plus 1
        for (std::size_t end = 0; end < Pattern::ends; ++end) {
            const auto& part = pattern.part[Pattern::ends + end];
            unsigned bits = 0;
            for (std::size_t i = 0; i < Pattern::corners; ++i) {
                bits |= (signs >> part.corner[i] & 1U) << i;
            }
            if (bits == 0 || bits == all) continue;
            const Piece& from = piece(bits);
            Loop loop{static_cast<std::uint8_t>(end), from.count, part.mirrored, {}};
            for (std::size_t i = 0; i < from.count; ++i) {
                const Cut cut{part.corner[from.cut[i].low], part.corner[from.cut[i].high]};
                std::uint8_t& known = number[cut.low][cut.high];
                if (known == 0) {
                    cuts_.push_back(cut);
                    known = ++contour.cut_count;
                }
                loop.cut[i] = static_cast<std::uint8_t>(known - 1);
            }
            loops_.push_back(loop);
            ++contour.loop_count;
            if (loop.count == 4) ++contour.simplex_count;
            ++contour.simplex_count;
            contour.ends |= static_cast<std::uint8_t>(1U << end);
        }
        contours_.push_back(contour);
    }
    cuts_.resize(cuts_.size() + cuts_at_once);
    loops_.resize(loops_.size() + loops_at_once);
}

inline BlockContours::Piece BlockContours::make_piece(Shape shape, unsigned signs) {
    Piece piece;
    const ContourLoop& from = ContourTable::of(shape).plain(signs)->loop[0];
    piece.count = from.count;
    for (std::size_t i = 0; i < from.count; ++i) {
        const auto& [a, b] = topology(shape).edge[from.edge[i]];
        const bool falls = (signs >> a & 1U) != 0;
        piece.cut[i] = {falls ? b : a, falls ? a : b};
        piece.face[i] = from.face[i];
    }
    return piece;
}

}  // namespace nestgrid
