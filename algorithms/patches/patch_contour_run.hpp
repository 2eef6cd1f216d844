// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of all selected patches of a batch in three dense lists: cuts, simplices and
// quadrilaterals. Loops over dense lists have predictable ends; loops over the cuts of a single
// patch do not.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <span>

#include <patches/patch_contours.hpp>

namespace nestgrid::engine {

/// \tparam pattern the pattern of bisections of the patches
template <const auto& pattern>
class PatchContourRun {
    using Contour = PatchContours::Contour;
    using Front = PatchContours::Front;

public:
    using Cut = BatchEdge;
    using Corners = std::array<std::uint16_t, 3>;  // numbers of cuts; a segment has two
    struct Quad {
        std::uint16_t first_simplex;
        std::array<std::uint16_t, 4> cut;
        std::uint16_t mirrored;  // odd: its simplex is mirrored
        std::array<std::uint16_t, 2> unused;
    };

    // Limits for a full batch of patches and as many single simplices.
    static constexpr std::size_t most_quads = most_patches * (pattern.ends + 1);
    static constexpr std::size_t most_cuts = 4 * most_quads;
    static constexpr std::size_t most_simplices = 2 * most_quads;

    /// Appends the contour of a patch or a single simplex.
    /// \param id its id in the batch
    NESTGRID_INLINE void append(const Front& front, const Contour& contour, std::size_t id,
                                bool mirrored) {
        const auto slot = static_cast<std::uint16_t>(id % most_patches);
        const auto first = static_cast<std::uint16_t>(cut_count);
        const auto simplex = static_cast<std::uint16_t>(simplex_count);
        const auto turned = static_cast<std::uint16_t>(mirrored ? 1 : 0);
        const Eight by_slot{slot, slot, slot, slot, slot, slot, slot, slot};
        const Eight by_first{first, first, first, first, first, first, first, first};
        const Eight by_quad{simplex, first, first, first, first, turned, 0, 0};
        const auto* const cuts = front.cuts(contour);
        const auto* const simplices = front.simplices(contour, mirrored);
        const auto* const quads = front.quads(contour);
        constexpr std::size_t cuts_at_once = 12;
        constexpr std::size_t simplices_at_once = 8;
        constexpr std::size_t quads_at_once = 2;
        const auto put_cuts = [&](std::size_t from) NESTGRID_INLINE_LAMBDA {
            widen<2 * cuts_at_once, most_patches>(cuts + from, cut_.data() + cut_count + from,
                                                  by_slot);
        };
        const auto put_simplices = [&](std::size_t from) NESTGRID_INLINE_LAMBDA {
            widen<3 * simplices_at_once, 1>(simplices + from,
                                            simplex_.data() + simplex_count + from, by_first);
        };
        const auto put_fours = [&](std::size_t from) NESTGRID_INLINE_LAMBDA {
            widen<8 * quads_at_once, 1>(quads + from, quad_.data() + quad_count + from, by_quad);
        };
        put_cuts(0);
        put_simplices(0);
        put_fours(0);
        for (std::size_t i = cuts_at_once; i < contour.cut_count; i += cuts_at_once) put_cuts(i);
        for (std::size_t i = quads_at_once; i < contour.quad_count; i += quads_at_once) {
            put_fours(i);
        }
        if (contour.simplex_count > simplices_at_once) put_simplices(simplices_at_once);
        cut_count += contour.cut_count;
        simplex_count += contour.simplex_count;
        quad_count += contour.quad_count;
    }
    /// Appends the contour of one part of a patch of which not all drawn parts are selected.
    NESTGRID_NOINLINE void append_alone(const PatchContours& contours, unsigned bits,
                                        const std::array<std::uint16_t, 4>& places, bool mirrored);

    std::size_t cut_count = 0;
    std::size_t simplex_count = 0;
    std::size_t quad_count = 0;

    NESTGRID_INLINE std::span<const Cut> cuts() const { return {cut_.data(), cut_count}; }
    NESTGRID_INLINE std::span<const Quad> quads() const { return {quad_.data(), quad_count}; }
    NESTGRID_INLINE std::span<const Corners> simplices() const {
        return {simplex_.data(), simplex_count};
    }
    /// Divides a quadrilateral into two triangles.
    /// \param other whether to divide it along the diagonal from its second cut, not from its first
    NESTGRID_INLINE void divide(const Quad& quad, bool other) {
        // The corners of both triangles; a mirrored simplex swaps the first two of each.
        static constexpr std::array<std::array<std::uint8_t, 6>, 4> order{
            {{0, 1, 2, 2, 3, 0}, {1, 0, 2, 3, 2, 0}, {1, 2, 3, 3, 0, 1}, {2, 1, 3, 0, 3, 1}}};
        const auto& of = order[(other ? 2U : 0U) + quad.mirrored % 2U];
        Corners* const to = &simplex_[quad.first_simplex];
        to[0] = {quad.cut[of[0]], quad.cut[of[1]], quad.cut[of[2]]};
        to[1] = {quad.cut[of[3]], quad.cut[of[4]], quad.cut[of[5]]};
    }

private:
    static_assert(pattern.ends <= 8);
#if defined(__GNUC__)
    using Eight [[gnu::vector_size(16)]] = std::uint16_t;
#else
    using Eight = std::array<std::uint16_t, 8>;
#endif

    /// Copies numbers of 8 bits as numbers of 16 bits: to[i] = factor * from[i] + more[i % 8].
    template <std::size_t count, std::uint16_t factor, class From, class To>
    NESTGRID_INLINE static void widen(const From* from, To* to, const Eight& more) {
        static_assert(count % 8 == 0);
        const auto* const source = reinterpret_cast<const unsigned char*>(from);
        auto* const target = reinterpret_cast<unsigned char*>(to);
        unrolled<count / 8>([&](auto part) NESTGRID_INLINE_LAMBDA {
            Eight wide;
#if defined(__GNUC__)
            using Narrow [[gnu::vector_size(8)]] = std::uint8_t;
            Narrow narrow;
            std::memcpy(&narrow, source + 8 * part, sizeof(narrow));
            wide = __builtin_convertvector(narrow, Eight) * factor + more;
#else
            for (std::size_t i = 0; i < 8; ++i) {
                wide[i] = static_cast<std::uint16_t>(source[8 * part + i] * factor + more[i]);
            }
#endif
            std::memcpy(target + 16 * part, &wide, sizeof(wide));
        });
    }

    // Entries behind the counts are padding that append() overwrites.
    std::array<Cut, most_cuts + 32> cut_;
    std::array<Corners, most_simplices + 16> simplex_;
    std::array<Quad, most_quads + 8> quad_;
};

template <const auto& pattern>
void PatchContourRun<pattern>::append_alone(const PatchContours& contours, unsigned bits,
                                            const std::array<std::uint16_t, 4>& places,
                                            bool mirrored) {
    const PatchContours::Piece& piece = contours.piece(bits);
    std::array<std::uint16_t, 4> cut{};
    for (std::size_t i = 0; i < piece.count; ++i) {
        cut[i] = static_cast<std::uint16_t>(cut_count);
        cut_[cut_count++] = {places[piece.cut[i].low], places[piece.cut[i].high]};
    }
    const Quad quad{static_cast<std::uint16_t>(simplex_count),
                    cut,
                    mirrored ? std::uint16_t{1} : std::uint16_t{0},
                    {}};
    divide(quad, false);
    if (piece.count == 4) quad_[quad_count++] = quad;
    simplex_count += piece.count == 4 ? 2 : 1;
}

}  // namespace nestgrid::engine
