// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws the selected patches of a batch, level by level: lists the contours of all patches, finds
// or makes the vertices of all cuts, and appends the simplices. The surface has the order and the
// bits of the general walk.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <contours/contour_filling.hpp>
#include <contours/level.hpp>
#include <patches/edge_pieces.hpp>
#include <patches/patch_contour_run.hpp>
#include <surfaces/drawn_surface.hpp>
#include <surfaces/simplex_tally.hpp>

namespace nestgrid::engine {

/// The surfaces that batches are drawn into, one for each level. Borrows everything.
template <int dimension, class Real>
struct PatchTarget {
    std::span<const Level<Real>> levels;
    std::span<DrawnSurface<dimension>> surfaces;
    SimplexTally* tally;
    int* deepest;           ///< depth of the deepest element drawn so far
    bool carries = false;   ///< whether vertices carry a value (mean_values.hpp)
    bool at_nodes = false;  ///< whether to tell the surfaces which vertices lie at nodes
    bool normals = false;   ///< whether vertices have normals from gradients at nodes
    bool finest = false;    ///< whether to cut edges on their finest pieces
};

/// Draws one selection from a batch.
/// \tparam Patches a batch of patches
template <int dimension, class Real, class Patches>
class PatchDrawing {
    static constexpr const auto& pattern_ = Patches::pattern;
    static constexpr Shape shape_ = dimension == 2 ? Shape::triangle : Shape::tetrahedron;
    using Places = BatchPlaces<pattern_>;
    using Run = PatchContourRun<pattern_>;
    using Target = PatchTarget<dimension, Real>;
    using Surface = DrawnSurface<dimension>;
    using Number = typename Surface::Number;

public:
    PatchDrawing(const Target& target, const Patches& patches, const BatchSelection& selection)
        : target_{&target},
          patches_{&patches},
          selection_{&selection},
          contours_{&PatchContours::of<pattern_>()} {}

    /// Draws the selection. \return the number of leaves in patches that a level passes through
    unsigned draw() {
        std::array<std::uint8_t, 2 * most_patches> parts{};  // drawn parts, by id
        for (std::size_t l = 0; l < target_->levels.size(); ++l) {
            level_ = &target_->levels[l];
            surface_ = &target_->surfaces[l];
            set_signs();
            count_ = 0;
            for (std::size_t i = 0; i < selection_->count; ++i) {
                const std::size_t id = selection_->id[i];
                const auto see = [&](const Front& front) NESTGRID_INLINE_LAMBDA {
                    const auto& contour = front.at(static_cast<std::size_t>(signs_[id]));
                    parts[id] |= contour.parts;
                    entry_[count_] = {&front, &contour, 0, static_cast<std::uint16_t>(id)};
                    count_ += contour.parts == 0 ? 0 : 1;
                };
                if (!Places::is_patch(id)) {
                    see(contours_->alone());
                } else if (const auto* patch = contours_->patch(patches_->undivided[id])) {
                    see(*patch);
                } else {
                    see(contours_->half(2, patches_->undivided[id]));
                    see(contours_->half(3, patches_->undivided[id]));
                }
            }
            if (count_ > 0) draw_entries();
        }
        if (!selection_->ends_are_leaves) return 0;
        unsigned leaves = 0;
        for (std::size_t b = selection_->first_patch; b < selection_->end_of_patches; ++b) {
            leaves += count_bits(unsigned{parts[b]} & patches_->ends[b]);
        }
        return leaves;
    }

private:
    using Front = PatchContours::Front;
    struct Entry {  // a patch, half a patch or simplex that the level passes through
        const Front* front;
        const PatchContours::Contour* contour;
        std::uint16_t first_cut;
        std::uint16_t id;  // in the batch
    };

    std::span<const Entry> entries() const { return {entry_.data(), count_}; }
    int level_of(std::size_t id, int depth) const {
        return Places::is_patch(id) ? patches_->level + depth
                                    : int{patches_->element_levels[id % most_patches]};
    }

    /// Sets signs_: the nodes of each patch and simplex with U >= C, one bit each.
    NESTGRID_INLINE void set_signs() {
        using Bits = Pack<MaskOf<Real>>;
        const auto least_inside = Pack<Real>::all(level_->least_inside);
        const auto set = [&](auto rows, std::size_t first_row, std::size_t first, std::size_t end,
                             std::size_t to) NESTGRID_INLINE_LAMBDA {
            for (std::size_t b = first / pack * pack; b < end; b += pack) {
                auto signs = Bits::all(0);
                unrolled<rows>([&](auto i) NESTGRID_INLINE_LAMBDA {
                    const auto value = Pack<Real>::load(patches_->values[first_row + i] + b);
                    signs =
                        signs | (at_most(least_inside, value) & Bits::all(MaskOf<Real>{1} << i));
                });
                signs.store(signs_.data() + to + b);
            }
        };
        set(std::integral_constant<std::size_t, Places::patch_rows>{}, 0, selection_->first_patch,
            selection_->end_of_patches, 0);
        set(std::integral_constant<std::size_t, pattern_.corners>{}, Places::patch_rows, 0,
            patches_->element_count, most_patches);
    }

    /// The parts of a patch that are selected, one bit at the first end of each.
    NESTGRID_INLINE unsigned parts_meant(std::size_t id) const {
        if (!Places::is_patch(id)) return 1;
        const auto stops = static_cast<std::size_t>(patches_->stops[id]);
        return (selection_->ends_are_leaves ? unsigned{patches_->ends[id]} : 0U) |
               pattern_.first_ends[stops % pattern_.part_sets] |
               static_cast<unsigned>(stops / pattern_.part_sets);
    }

    /// Calls function(part, bits) for the selected parts of an entry. Bit i of `bits` says that
    /// corner i has U >= C. A single simplex is part 1.
    template <class Function>
    void for_each_part(const Entry& entry, Function&& function) const {
        const auto signs = static_cast<unsigned>(signs_[entry.id]);
        if (!Places::is_patch(entry.id)) return function(std::size_t{1}, signs);
        const unsigned meant = parts_meant(entry.id);
        const unsigned undivided = patches_->undivided[entry.id];
        for (std::size_t end = 0; end < pattern_.ends; ++end) {
            if ((entry.contour->parts & meant & 1U << end) == 0) continue;
            const std::size_t part = pattern_.part_above(end, undivided);
            function(part, PatchContours::signs_of(pattern_.part[part], pattern_.corners, signs));
        }
    }

    /// Draws the parts that the level passes through.
    NESTGRID_NOINLINE void draw_entries() {
        Run run;
        append_contours(run);
        if (run.simplex_count == 0) return;
        surface_->report().extracted += run.simplex_count - run.quad_count;
        target_->tally->add(run.simplex_count);
        if (surface_->counts_only()) return;
        if (surface_->builder().takes_batches() && !target_->carries && !target_->at_nodes) {
            return hand_over(run);
        }

        std::array<Number, Run::most_cuts> v;
        if (surface_->names_vertices()) {
            find_vertices(run.cuts(), v.data());
        } else {
            make_vertices(run.cuts(), v.data());
        }
        for (const auto& quad : run.quads()) {
            const auto x = [&](std::size_t i) { return surface_->position(v[quad.cut[i]]); };
            run.divide(quad, !shorter(x(0), x(2), x(1), x(3)));
        }
        std::array<ExtractedElement, Run::most_quads> elements;
        const std::size_t count =
            surface_->builder().keeps_elements() ? list_elements(elements) : 0;
        surface_->builder().add_extracted(std::span<const ExtractedElement>(elements).first(count),
                                          std::span<const Number>(v).first(run.cut_count),
                                          run.simplices());
        if (surface_->names_vertices()) put_boundaries(run.cuts(), v.data());
        if (target_->at_nodes) put_at_nodes(run.cuts(), v.data());
        surface_->builder().flush_if_full();
    }

    /// Hands the simplices to a sink as they lie in the run.
    NESTGRID_INLINE void hand_over(Run& run) {
        std::array<WidePoint, Run::most_cuts> x;
        cut(run.cuts(), true, x.data());
        for (const auto& quad : run.quads()) {
            const auto at = [&](std::size_t i) { return Point(x[quad.cut[i]]); };
            run.divide(quad, !shorter(at(0), at(2), at(1), at(3)));
        }
        surface_->builder().take_batch({reinterpret_cast<const double*>(x.data()),
                                        sizeof(WidePoint) / sizeof(double), run.simplices()});
    }

    /// Lists the drawn elements in order. \return their number
    std::size_t list_elements(std::array<ExtractedElement, Run::most_quads>& elements) const {
        std::size_t count = 0;
        for (const Entry& entry : entries()) {
            for_each_part(entry, [&](std::size_t part, unsigned bits) {
                elements[count++] = {patches_->element(entry.id, part), shape_,
                                     level_of(entry.id, pattern_.part[part].depth),
                                     contours_->piece(bits).count == 4 ? 2U : 1U};
            });
        }
        return count;
    }

    /// Lists the contours of all entries, and raises the depth and the error bound of the surface.
    NESTGRID_INLINE void append_contours(Run& run) {
        for (std::size_t k = 0; k < count_; ++k) {
            Entry& entry = entry_[k];
            const std::size_t id = entry.id;
            const unsigned meant = parts_meant(id);
            *target_->deepest = std::max(*target_->deepest, level_of(id, entry.contour->depth));
            if (static_cast<double>(patches_->greatest_bounds[id]) >
                surface_->report().error_bound) {
                raise_error_bound(id, entry.contour->parts & meant);
            }
            entry.first_cut = static_cast<std::uint16_t>(run.cut_count);
            if ((entry.contour->parts & ~meant) == 0) {
                run.append(*entry.front, *entry.contour, id, patches_->mirrored(id));
                continue;
            }
            for_each_part(entry, [&](std::size_t part, unsigned bits) {
                std::array<std::uint16_t, 4> places{};
                for (std::size_t i = 0; i < pattern_.corners; ++i) {
                    places[i] =
                        static_cast<std::uint16_t>(Places::of(id, pattern_.part[part].corner[i]));
                }
                run.append_alone(*contours_, bits, places,
                                 patches_->mirrored(id) != pattern_.part[part].mirrored);
            });
        }
    }

    /// Raises the error bound by the bounds of the drawn parts at which the walk stopped.
    /// \param parts the drawn parts, one bit at the first end of each
    NESTGRID_NOINLINE void raise_error_bound(std::size_t id, unsigned parts) {
        const auto raise = [&](Real bound) {
            surface_->report().raise_error_bound(static_cast<double>(bound));
        };
        if (!Places::is_patch(id)) return raise(patches_->greatest_bounds[id]);
        for (std::size_t part = 2; part < 2 * pattern_.ends; ++part) {
            if ((patches_->stops[id] >> (part - 2) & 1U) == 0) continue;
            if ((parts >> pattern_.first_end(part) & 1U) != 0) raise(patches_->bounds[part][id]);
        }
    }

    /// Whether a face of a patch or simplex lies on a face of the root (subtree_nodes.hpp), as all
    /// faces on the boundary of the domain do.
    NESTGRID_INLINE bool is_on_root_face(std::size_t id) const {
        SubtreeNode faces = 0;
        for (std::size_t across = 0; across < pattern_.corners; ++across) {
            SubtreeNode of_all = root_faces;
            for (std::size_t i = 0; i < pattern_.corners; ++i) {
                if (i != across) of_all &= patches_->in_subtree[0][Places::of(id, i)];
            }
            faces |= of_all;
        }
        return faces != 0;
    }

    /// Tells the builder which sides of loops lie on the boundary of the domain.
    NESTGRID_INLINE void put_boundaries(std::span<const BatchEdge> cuts, const Number* v) {
        for (const Entry& entry : entries()) {
            const std::size_t id = entry.id;
            if (!is_on_root_face(id) || patches_->boundary(id, 1) == 0) continue;
            for_each_part(entry, [&](std::size_t part, unsigned bits) {
                const auto& piece = contours_->piece(bits);
                const auto place = [&](std::size_t corner) {
                    return Places::of(id, pattern_.part[part].corner[corner]);
                };
                std::array<Number, 4> corners;
                for (std::size_t i = 0; i < piece.count; ++i) {
                    std::size_t cut = entry.first_cut;
                    while (cuts[cut].low != place(piece.cut[i].low) ||
                           cuts[cut].high != place(piece.cut[i].high)) {
                        ++cut;
                    }
                    corners[i] = v[cut];
                }
                put_boundary(corners, piece, patches_->boundary(id, part));
            });
        }
    }
    void put_boundary(const std::array<Number, 4>& corners, const PatchContours::Piece& piece,
                      unsigned boundary) {
        for (std::size_t i = 0; i < piece.count; ++i) {
            if ((boundary >> piece.face[i] & 1U) == 0) continue;
            typename nestgrid::Surface<dimension>::Ridge ridge;
            for (std::size_t k = 0; k < ridge.size(); ++k) {
                ridge[k] = corners[(i + k) % piece.count];
            }
            surface_->builder().add_boundary(ridge);
        }
    }

    // Defined in patch_vertices.hpp.
    void find_vertices(std::span<const BatchEdge> cuts, Number* v);
    void make_vertices(std::span<const BatchEdge> cuts, Number* v);
    void add_vertices(std::span<const BatchEdge> cuts);
    void cut(std::span<const BatchEdge> cuts, bool adds, WidePoint* to);
    void cut_pieces(std::span<const BatchEdge> cuts, bool adds, WidePoint* to);
    void carry(std::span<const BatchEdge> cuts, double* to) const;
    void put_at_nodes(std::span<const BatchEdge> cuts, const Number* v);
    CutLevel cut_level() const { return {level_->value, level_->least_fraction}; }
    void verify_vertices(std::span<const BatchEdge> cuts, const Number* v);

    const Target* target_;
    const Patches* patches_;
    const BatchSelection* selection_;
    const PatchContours* contours_;
    const Level<Real>* level_ = nullptr;
    Surface* surface_ = nullptr;
    std::array<MaskOf<Real>, 2 * most_patches> signs_;  // nodes with U >= C, by id
    std::size_t count_ = 0;
    std::array<Entry, 3 * most_patches + 1> entry_;  // a patch drawn as two halves takes two
};

}  // namespace nestgrid::engine

#include <patches/patch_vertices.hpp>
