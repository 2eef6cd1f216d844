// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of contours, by the signs at the nodes of a patch of simplices.
//
// A contour holds the loops of all parts of the patch that are drawn: its ends, or larger parts
// that are not divided. It lists every cut edge once. A patch whose drawn parts have more than
// seven nodes is drawn as two halves, which keeps the tables an eighth of the size.
#pragma once

#include <bit>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <contours/contour_table.hpp>
#include <patches/patch_batch.hpp>

namespace nestgrid::engine {

/// The contours of patches, of halves of patches and of single simplices. Simplices refer to cuts
/// by their number within the contour.
class PatchContours {
public:
    struct Cut {
        std::uint8_t low;   ///< the node with U < C, or its row in a batch
        std::uint8_t high;  ///< the node with U >= C, or its row in a batch
    };
    /// The loop of one simplex: a segment, a triangle, or a quadrilateral that may be divided along
    /// either diagonal. Cuts name corners of the simplex in the place of nodes.
    struct Piece {
        std::uint8_t count = 0;
        std::array<Cut, 4> cut{};
        std::array<std::uint8_t, 4> face{};  ///< that of the side from cut i to i + 1
    };
    struct Contour {
        std::uint32_t first_cut = 0;
        std::uint32_t first_simplex = 0;
        std::uint32_t first_quad = 0;
        std::uint8_t cut_count = 0;
        std::uint8_t simplex_count = 0;
        std::uint8_t parts = 0;      ///< parts that have a loop, one bit at the first end of each
        std::uint8_t depth : 4 = 0;  ///< depth in the patch of the deepest of these parts
        std::uint8_t quad_count : 4 = 0;
    };
    /// The three cuts that are the corners of a triangle; in two dimensions the first two.
    using Corners = std::array<std::uint8_t, 3>;
    /// A quadrilateral of four cuts, drawn as two triangles along either diagonal.
    struct Quad {
        std::uint8_t first_simplex;  ///< the first of the two triangles in the contour
        std::array<std::uint8_t, 4> cut;
        std::uint8_t mirrored;  ///< whether its simplex is mirrored relative to the patch
        std::array<std::uint8_t, 2> unused;
    };

    /// The contours of parts that together fill a patch or a half of one, or of a single simplex.
    class Front {
    public:
        /// \param signs bit i says that node i of the patch (corner i of a simplex) has U >= C
        NESTGRID_INLINE const Contour& at(std::size_t signs) const {
            return contours_[number_[signs & nodes_]];
        }
        // Readers copy fixed numbers of entries: the arrays are padded behind the last contour.
        /// The cuts of a contour, in the order in which its parts first use them.
        NESTGRID_INLINE const Cut* cuts(const Contour& c) const {
            return cuts_.data() + c.first_cut;
        }
        /// The simplices of a contour, in the order of its parts. Those of mirrored patches lie
        /// behind those of patches that are not mirrored.
        NESTGRID_INLINE const Corners* simplices(const Contour& c, bool mirrored) const {
            // Branch-free: mirroring is unpredictable.
            return simplices_.data() + c.first_simplex + (c.simplex_count & (mirrored ? ~0U : 0U));
        }
        NESTGRID_INLINE const Quad* quads(const Contour& c) const {
            return quads_.data() + c.first_quad;
        }

    private:
        friend class PatchContours;

        std::size_t nodes_ = 0;  // nodes of the parts, one bit each
        std::vector<std::uint16_t> number_;
        std::vector<Contour> contours_;
        std::vector<Cut> cuts_;
        std::vector<Corners> simplices_;
        std::vector<Quad> quads_;
    };

    /// The tables of a pattern of bisections. The first call makes them.
    template <const auto& pattern>
    static const PatchContours& of() {
        static const PatchContours table{Of<pattern>{}};
        return table;
    }

    /// The contours of a single simplex.
    const Front& alone() const { return alone_; }
    /// The contours of a patch.
    /// \param undivided the set of inner parts that are not divided
    /// \return null where the patch must be drawn as two halves
    NESTGRID_INLINE const Front* patch(std::size_t undivided) const { return patch_[undivided]; }
    /// The contours of one half of a patch.
    /// \param part 2 or 3
    NESTGRID_INLINE const Front& half(std::size_t part, unsigned undivided) const {
        return half_[part - 2][number_of_half(part, undivided)];
    }
    /// The loop of a single simplex.
    /// \param signs bit i says that corner i has U >= C
    const Piece& piece(unsigned signs) const { return pieces_[signs]; }
    /// The signs at the corners of a part of a patch.
    template <class Part>
    static unsigned signs_of(const Part& part, std::size_t corners, unsigned signs) {
        unsigned bits = 0;
        for (std::size_t i = 0; i < corners; ++i) bits |= (signs >> part.corner[i] & 1U) << i;
        return bits;
    }

private:
    template <const auto& pattern>
    struct Of {};
    template <const auto& pattern>
    explicit PatchContours(Of<pattern>);

    template <const auto& pattern>
    struct Maker;

    /// A patch whose drawn parts have more nodes is drawn as two halves.
    static constexpr std::size_t most_nodes_ = 7;

    /// The index of the contours of a half: bit 0 says that the half is not divided, bits 1 and 2
    /// that its children are not.
    static constexpr std::size_t number_of_half(std::size_t part, unsigned undivided) {
        return (undivided >> (part - 2) & 1U) | (undivided >> (2 * part - 2) & 3U) << 1U;
    }
    static Piece make_piece(Shape shape, unsigned signs);

    std::array<Piece, 16> pieces_;
    Front alone_;
    std::vector<std::unique_ptr<const Front>> patches_;
    std::array<const Front*, 64> patch_{};
    std::array<std::array<Front, 8>, 2> half_;
};

/// Makes the contours of one front.
template <const auto& pattern>
struct PatchContours::Maker {
    using Patch = std::remove_cvref_t<decltype(pattern)>;
    static constexpr unsigned all = (1U << pattern.corners) - 1;

    const PatchContours& table;
    Front front{};
    Contour contour{};
    std::array<std::array<std::uint8_t, 16>, 16> number{};  // 1 + the number of a cut; 0: none

    /// The nodes of some parts, one bit each.
    template <class Parts>
    static std::size_t nodes_of(const Parts& parts) {
        std::size_t nodes = 0;
        for (const auto& [part, end] : parts) {
            for (std::size_t i = 0; i < pattern.corners; ++i) {
                nodes |= std::size_t{1} << pattern.part[part].corner[i];
            }
        }
        return nodes;
    }
    void begin() {
        contour = {};
        number = {};
        contour.first_cut = static_cast<std::uint32_t>(front.cuts_.size());
        contour.first_simplex = static_cast<std::uint32_t>(front.simplices_.size());
        contour.first_quad = static_cast<std::uint32_t>(front.quads_.size());
    }
    /// Adds the loop of a part to the contour.
    /// \param first_row the row of node 0 in a batch
    void add(unsigned signs, const typename Patch::Part& part, std::size_t end,
             std::size_t first_row) {
        const unsigned bits = signs_of(part, pattern.corners, signs);
        if (bits == 0 || bits == all) return;
        const Piece& piece = table.piece(bits);
        std::array<std::uint8_t, 4> cut{};
        for (std::size_t i = 0; i < piece.count; ++i) {
            const std::size_t low = part.corner[piece.cut[i].low];
            const std::size_t high = part.corner[piece.cut[i].high];
            std::uint8_t& known = number[low][high];
            if (known == 0) {
                front.cuts_.push_back({static_cast<std::uint8_t>(first_row + low),
                                       static_cast<std::uint8_t>(first_row + high)});
                known = ++contour.cut_count;
            }
            cut[i] = static_cast<std::uint8_t>(known - 1);
        }
        if (piece.count == 4) {
            front.quads_.push_back({contour.simplex_count, cut, part.mirrored, {}});
            contour.quad_count = static_cast<std::uint8_t>(contour.quad_count + 1) & 15U;
        }
        add_corners({cut[0], cut[1], cut[2]}, part.mirrored);
        if (piece.count == 4) add_corners({cut[2], cut[3], cut[0]}, part.mirrored);
        contour.parts |= static_cast<std::uint8_t>(1U << end);
        contour.depth = std::max<std::uint8_t>(contour.depth, part.depth) & 15U;
    }
    void add_corners(Corners corners, bool mirrored) {
        if (mirrored) std::swap(corners[0], corners[1]);
        front.simplices_.push_back(corners);
        ++contour.simplex_count;
    }
    /// Adds the mirrored simplices, and files the contour under its signs.
    void finish(std::size_t signs) {
        front.number_[signs] = static_cast<std::uint16_t>(front.contours_.size());
        for (std::size_t i = 0; i < contour.simplex_count; ++i) {
            Corners corners = front.simplices_[contour.first_simplex + i];
            std::swap(corners[0], corners[1]);
            front.simplices_.push_back(corners);
        }
        front.contours_.push_back(contour);
    }
    /// Makes the contours of some parts, for all signs at their nodes.
    /// \param parts pairs of a part and its first end
    /// \param first_row the row of node 0 in a batch
    template <class Parts>
    Front make(const Parts& parts, std::size_t first_row) {
        front.nodes_ = nodes_of(parts);
        front.number_.resize(front.nodes_ + 1);
        for (std::size_t signs = 0; signs <= front.nodes_; ++signs) {
            if ((signs & ~front.nodes_) != 0) continue;
            begin();
            for (const auto& [part, end] : parts) {
                add(static_cast<unsigned>(signs), pattern.part[part], end, first_row);
            }
            finish(signs);
        }
        front.cuts_.resize(front.cuts_.size() + 4 * pack);
        front.simplices_.resize(front.simplices_.size() + 3 * pack);
        front.quads_.resize(front.quads_.size() + pack);
        front.contours_.shrink_to_fit();
        front.cuts_.shrink_to_fit();
        front.simplices_.shrink_to_fit();
        front.quads_.shrink_to_fit();
        return std::move(front);
    }
};

template <const auto& pattern>
PatchContours::PatchContours(Of<pattern>) {
    using Made = Maker<pattern>;
    const Shape shape = pattern.corners == 3 ? Shape::triangle : Shape::tetrahedron;
    for (unsigned bits = 1; bits < Made::all; ++bits) pieces_[bits] = make_piece(shape, bits);

    using Parts = std::vector<std::pair<std::size_t, std::size_t>>;  // a part and its first end
    alone_ = Made{*this}.make(Parts{{1, 0}}, BatchPlaces<pattern>::patch_rows);

    if constexpr (pattern.height > 0) {
        static_assert(pattern.part_sets <= 64);
        const auto parts_of = [](std::size_t first, std::size_t end, unsigned undivided) {
            Parts parts;
            for (; first < end; ++first) {
                const std::size_t p = pattern.part_above(first, undivided);
                const bool is_first = p >= pattern.ends || pattern.first_end(p) == first;
                if (is_first) parts.emplace_back(p, first);
            }
            return parts;
        };
        std::map<Parts, const Front*> known;
        for (unsigned undivided = 0; undivided < pattern.part_sets; ++undivided) {
            for (const std::size_t half : {std::size_t{2}, std::size_t{3}}) {
                Front& front = half_[half - 2][number_of_half(half, undivided)];
                if (!front.number_.empty()) continue;
                front = Made{*this}.make(parts_of((half - 2) * pattern.ends / 2,
                                                  (half - 1) * pattern.ends / 2, undivided),
                                         0);
            }
            const Parts parts = parts_of(0, pattern.ends, undivided);
            const std::size_t nodes = Made::nodes_of(parts);
            if (undivided != 0 && static_cast<std::size_t>(std::popcount(nodes)) > most_nodes_) {
                continue;
            }
            const Front*& front = known[parts];
            if (front == nullptr) {
                patches_.push_back(std::make_unique<const Front>(Made{*this}.make(parts, 0)));
                front = patches_.back().get();
            }
            patch_[undivided] = front;
        }
    }
}

inline PatchContours::Piece PatchContours::make_piece(Shape shape, unsigned signs) {
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

}  // namespace nestgrid::engine
