// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks over bisections known at compile time; included by isosurface_steps.hpp. What is drawn, and
// in which order, is what the plain traversal draws, to the last bit.
#pragma once

#include <nestgrid/algorithms/isosurface.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

template <class Grid, class Field, class S, class Indicator, class Sink>
void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::walk_bisections(const State& s) {
    if constexpr (knows_bisections) {
        nestgrid::walk_bisections(walk_->grid(), walk_->field(), *this, s.element, s.value.data(),
                                  s.level, s.orientation, [&](const auto& walk) {
                                      count(walk.looked_at(), walk.visited());
                                  });
    } else if constexpr (is_erased) {
        struct Erased final : ErasedBisectionVisitor<dimension, Real> {
            IsosurfaceVisitor* to;
            explicit Erased(IsosurfaceVisitor* visitor) : to{visitor} {}

            typename ErasedBisectionVisitor<dimension, Real>::Glance glance(
                Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                bool outside) override {
                const auto [visit, bound] = to->glance(lo, hi, rule, node, level, outside);
                return {visit, bound};
            }
            bool glance_at_leaf(Real lo, Real hi) override { return to->glance_at_leaf(lo, hi); }
            PackedGlance<Real> glance(const PackedElements<Real>& e) override {
                return to->glance(e);
            }
            void expect(const NodeKey* nodes) const override { to->expect(nodes); }
            bool names_edges() const override { return indexed; }
            void begin_subtrees(std::uint32_t numbers) override {
                if constexpr (indexed) to->begin_subtrees(numbers);
            }
            unsigned extract(const ErasedBlocks<dimension, Real>& blocks,
                             const BatchSelection& selection) override {
                return to->extract(blocks, selection);
            }
            void tick(std::uint64_t calls, std::uint64_t visited) override {
                to->tick(calls, visited);
            }
            void end(std::uint64_t calls, std::uint64_t visited) override {
                to->count(calls, visited);
            }
        } erased(this);
        walk_->field().bisect(walk_->grid(), *s.context, s.element, s.value.data(), s.level,
                              s.orientation, erased);
    }
}

NESTGRID_VISITOR::knows_bisections_of_grid() const -> bool {
    if constexpr (is_erased) return walk_->field().bisects(walk_->grid());
    return knows_bisections;
}

template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::glance(
    Real lo, Real hi, const Rule& rule, NodeKey node, int level, bool outside) -> Glance {
    const std::span<const NodeKey> keys(&node, 1);
    const Real bound = bound_of(keys);
    if (!of_interest(lo, hi, bound, false)) return {Visit::skip, bound};
    const NodeMask mask =
        (*criterion_)(NewNodes{rule, keys, level + 1, outside ? NodeMask{1} : NodeMask{0}});
    return {mask != 0 ? Visit::stop : Visit::descend, bound};
}

/// The same of eight, without a branch.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::glance(
    const PackedElements<Real>& e) -> PackedGlance<Real> {
    using Reals = Pack<Real>;
    using Mask = typename Reals::Mask;
    PackedGlance<Real> result;
    Mask holds;
    if constexpr (requires(const S& s) {
                      { s.holds(e.node, *indicator_, indicator_->look_up(e.node)) }
                          -> std::same_as<Mask>;
                  }) {
        const auto known = indicator_->look_up(e.node);
        result.bound = known.bound();
        holds = criterion_->holds(e.node, *indicator_, known);
    } else {
        const auto key = [&](auto i) NESTGRID_INLINE_LAMBDA {
            return std::span<const NodeKey>(e.node + i, 1);
        };
        result.bound =
            Reals::make([&](auto i) NESTGRID_INLINE_LAMBDA { return bound_of(key(i)); });
        holds = Mask::make([&](auto i) NESTGRID_INLINE_LAMBDA {
            const NodeMask mask = (*criterion_)(NewNodes{e.rule, key(i), e.level + 1, 0});
            return mask != 0 ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        });
    }
    auto interest = Mask::all(0);
    for (const Layer& layer : layers_) {
        interest = interest | at_most(max(Reals::all(layer.least_inside) - e.hi,
                                          e.lo - Reals::all(layer.greatest_outside)),
                                      result.bound);
    }
    result.descend = without(interest, holds);
    result.stop = interest & holds;
    return result;
}

/// Of each block and element which nodes have U >= C.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::set_signs(
    const Blocks& blocks, const BatchSelection& selection, Layer& layer) {
    using Places = BatchPlaces<Blocks::pattern>;
    using Bits = Pack<MaskOf<Real>>;
    const auto least_inside = Pack<Real>::all(layer.least_inside);
    const auto set = [&](auto rows, std::size_t first_row, std::size_t first, std::size_t end,
                         std::size_t to) NESTGRID_INLINE_LAMBDA {
        for (std::size_t b = first / pack * pack; b < end; b += pack) {
            auto signs = Bits::all(0);
            unrolled<rows>([&](auto i) NESTGRID_INLINE_LAMBDA {
                const auto value = Pack<Real>::load(blocks.values[first_row + i] + b);
                signs = signs | (at_most(least_inside, value) & Bits::all(MaskOf<Real>{1} << i));
            });
            signs.store(layer.signs.data() + to + b);
        }
    };
    set(std::integral_constant<std::size_t, Places::block_rows>{}, 0, selection.first_block,
        selection.end_of_blocks, 0);
    set(std::integral_constant<std::size_t, Blocks::pattern.corners>{}, Places::block_rows, 0,
        blocks.element_count, most_blocks);
}

/// \return in how many leaves of blocks there is anything to draw
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract(
    const Blocks& blocks, const BatchSelection& selection) {
    constexpr const auto& pattern = Blocks::pattern;
    const BlockContours& contours = BlockContours::of<pattern>();
    std::array<std::uint8_t, 2 * most_blocks> parts{};  // by number
    for (Layer& layer : layers_) {
        layer_ = &layer;
        set_signs(blocks, selection, layer);
        CutList list;
        for (std::size_t i = 0; i < selection.count; ++i) {
            const std::size_t id = selection.id[i];
            const auto see = [&](const BlockContours::Front& front) NESTGRID_INLINE_LAMBDA {
                const auto& contour = front.at(static_cast<std::size_t>(layer.signs[id]));
                parts[id] |= contour.parts;
                list.entry[list.count] = {&front, &contour, 0, static_cast<std::uint16_t>(id)};
                list.count += contour.parts == 0 ? 0 : 1;
            };
            if (!BatchPlaces<pattern>::is_block(id)) {
                see(contours.alone());
            } else if (const auto* block = contours.block(blocks.undivided[id])) {
                see(*block);
            } else {
                see(contours.half(2, blocks.undivided[id]));
                see(contours.half(3, blocks.undivided[id]));
            }
        }
        if (list.count > 0) draw_list(blocks, selection, layer, contours, list);
    }
    if (!selection.ends_are_leaves) return 0;
    unsigned leaves = 0;
    for (std::size_t b = selection.first_block; b < selection.end_of_blocks; ++b) {
        leaves += count_bits(unsigned{parts[b]} & blocks.ends[b]);
    }
    return leaves;
}

/// The parts of a block that are meant to be drawn, each by its first end, one bit each.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::parts_meant(
    const Blocks& blocks, const BatchSelection& selection, std::size_t id) {
    constexpr const auto& pattern = Blocks::pattern;
    if (!BatchPlaces<pattern>::is_block(id)) return 1;
    const auto stops = static_cast<std::size_t>(blocks.stops[id]);
    return (selection.ends_are_leaves ? unsigned{blocks.ends[id]} : 0U) |
           pattern.first_ends[stops % pattern.part_sets] |
           static_cast<unsigned>(stops / pattern.part_sets);
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_list(
    const Blocks& blocks, const BatchSelection& selection, Layer& layer,
    const BlockContours& contours, CutList& list) {
    constexpr const auto& pattern = Blocks::pattern;
    using Places = BatchPlaces<pattern>;
    using Run = BlockContourRun<pattern>;
    const auto level_of = [&](std::size_t id, int depth) {
        return Places::is_block(id) ? blocks.level + depth
                                    : int{blocks.element_levels[id % most_blocks]};
    };
    Run run;
    for (std::size_t k = 0; k < list.count; ++k) {
        CutEntry& entry = list.entry[k];
        const std::size_t id = entry.id;
        const unsigned meant = parts_meant(blocks, selection, id);
        deepest_ = std::max(deepest_, level_of(id, entry.contour->depth));
        if (static_cast<double>(blocks.greatest_bounds[id]) > layer.error_bound) {
            raise_error_bound(blocks, layer, id, entry.contour->parts & meant);
        }
        entry.first_cut = static_cast<std::uint16_t>(run.cut_count);
        if ((entry.contour->parts & ~meant) == 0) {
            run.append(*entry.front, *entry.contour, id, blocks.mirrored(id));
            continue;
        }
        for_each_part(blocks, selection, layer, entry, [&](std::size_t part, unsigned bits) {
            std::array<std::uint16_t, 4> places{};
            for (std::size_t i = 0; i < pattern.corners; ++i) {
                places[i] =
                    static_cast<std::uint16_t>(Places::of(id, pattern.part[part].corner[i]));
            }
            run.append_alone(contours, bits, places,
                             blocks.mirrored(id) != pattern.part[part].mirrored);
        });
    }
    if (run.simplex_count == 0) return;
    layer.extracted += run.simplex_count - run.four_count;
    count_simplices(run.simplex_count);

    std::array<BlockVertex, Run::most_cuts> v;
    if constexpr (indexed) {
        find_vertices(blocks, layer, run.cuts(), v.data());
    } else {
        blocks.cuts(run.cuts(), layer.isovalue, v.data());
    }
    for (const auto& four : run.fours()) {
        const auto x = [&](std::size_t i) -> decltype(auto) {
            if constexpr (indexed) {
                return layer.sink.position(v[four.cut[i]]);
            } else {
                return (v[four.cut[i]]);
            }
        };
        run.divide(four, !shorter(x(0), x(2), x(1), x(3)));
    }
    const auto vertices = std::span<const BlockVertex>(v).first(run.cut_count);
    if (!keeps_elements(layer.sink)) {
        put_simplices(layer, vertices, run.simplices());
    } else {
        std::array<Extracted, Run::most_fours> elements;
        std::size_t count = 0;
        for (const CutEntry& entry : list.entries()) {
            for_each_part(blocks, selection, layer, entry, [&](std::size_t part, unsigned bits) {
                elements[count++] = {blocks.element(entry.id, part), simplex_shape,
                                     level_of(entry.id, pattern.part[part].depth),
                                     contours.piece(bits).count == 4 ? 2U : 1U};
            });
        }
        put_extracted(layer, std::span<const Extracted>(elements).first(count), vertices,
                      run.simplices());
    }
    if constexpr (indexed) {
        put_boundaries(blocks, selection, layer, contours, list, run.cuts(), v.data());
    }
}

/// function(part, bits) for those that are drawn; bits: at which corners U >= C. An element is its
/// part 1.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks, class Function>
void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::for_each_part(
    const Blocks& blocks, const BatchSelection& selection, const Layer& layer,
    const CutEntry& entry, Function&& function) const {
    constexpr const auto& pattern = Blocks::pattern;
    const auto signs = static_cast<unsigned>(layer.signs[entry.id]);
    if (!BatchPlaces<pattern>::is_block(entry.id)) return function(std::size_t{1}, signs);
    const unsigned meant = parts_meant(blocks, selection, entry.id);
    const unsigned undivided = blocks.undivided[entry.id];
    for (std::size_t end = 0; end < pattern.ends; ++end) {
        if ((entry.contour->parts & meant & 1U << end) == 0) continue;
        const std::size_t part = pattern.part_above(end, undivided);
        function(part, BlockContours::signs_of(pattern.part[part], pattern.corners, signs));
    }
}

/// \param parts drawn, each by its first end, one bit each
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::raise_error_bound(
    const Blocks& blocks, Layer& layer, std::size_t id, unsigned parts) const {
    constexpr const auto& pattern = Blocks::pattern;
    const auto raise = [&](Real bound) {
        layer.error_bound = std::max(layer.error_bound, static_cast<double>(bound));
    };
    if (!BatchPlaces<pattern>::is_block(id)) return raise(blocks.greatest_bounds[id]);
    for (std::size_t part = 2; part < 2 * pattern.ends; ++part) {
        if ((blocks.stops[id] >> (part - 2) & 1U) == 0) continue;
        if ((parts >> pattern.first_end(part) & 1U) != 0) raise(blocks.bounds[part][id]);
    }
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Corners>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_simplices(
    Layer& layer, std::span<const BlockVertex> v, std::span<const Corners> all) {
    if constexpr (requires { layer.sink.add_simplices(v, all); }) {
        layer.sink.add_simplices(v, all);
    } else {
        for (const Corners& corners : all) put_simplex(layer, v, corners);
    }
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Corners>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_extracted(
    Layer& layer, std::span<const Extracted> elements, std::span<const BlockVertex> v,
    std::span<const Corners> all) {
    if constexpr (requires { layer.sink.add_extracted(elements, v, all); }) {
        layer.sink.add_extracted(elements, v, all);
    } else {
        for (const Extracted& e : elements) {
            layer.sink.add_element(e.element, e.shape, e.level);
            for (const Corners& corners : all.first(e.simplices)) put_simplex(layer, v, corners);
            all = all.subspan(e.simplices);
        }
    }
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Corners>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_simplex(
    Layer& layer, std::span<const BlockVertex> v, const Corners& corners) {
    std::array<Vertex, static_cast<std::size_t>(dimension)> simplex;
    for (std::size_t k = 0; k < simplex.size(); ++k) simplex[k] = Vertex(v[corners[k]]);
    layer.sink.add_simplex(simplex, {});
}

/// Sides of loops on the boundary of the domain.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_boundaries(
    const Blocks& blocks, const BatchSelection& selection, const Layer& layer,
    const BlockContours& contours, const CutList& list, std::span<const BatchEdge> cuts,
    const Number* v) {
    constexpr const auto& pattern = Blocks::pattern;
    for (const CutEntry& entry : list.entries()) {
        const std::size_t id = entry.id;
        if (blocks.boundary(id, 1) == 0) continue;
        for_each_part(blocks, selection, layer, entry, [&](std::size_t part, unsigned bits) {
            const auto& piece = contours.piece(bits);
            const auto place = [&](std::size_t corner) {
                return BatchPlaces<pattern>::of(id, pattern.part[part].corner[corner]);
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
            put_boundary(corners, piece.count, piece.face, blocks.boundary(id, part));
        });
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
