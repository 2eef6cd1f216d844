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
            void extract_part(const ErasedBlocks<dimension, Real>& blocks, std::size_t b,
                              std::size_t part, Real bound) override {
                to->extract_part(blocks, b, part, bound);
            }
            void begin_subtrees() override {
                if constexpr (indexed) to->begin_subtrees();
            }
            unsigned extract_blocks(const ErasedBlocks<dimension, Real>& blocks, std::size_t first,
                                    std::size_t end, const std::uint8_t* entered) override {
                return to->extract_blocks(blocks, first, end, entered);
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

/// Which nodes of blocks first ... end - 1 have U >= C.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::set_signs(
    const Blocks& blocks, std::size_t first, std::size_t end, Layer& layer) {
    using Bits = Pack<MaskOf<Real>>;
    const auto least_inside = Pack<Real>::all(layer.least_inside);
    for (std::size_t b = first / pack * pack; b < end; b += pack) {
        auto signs = Bits::all(0);
        unrolled<Blocks::pattern.nodes>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const auto value = Pack<Real>::load(blocks.row(i) + b);
            signs = signs | (at_most(least_inside, value) & Bits::all(MaskOf<Real>{1} << i));
        });
        signs.store(layer.signs.data() + b);
    }
}

/// The names of all vertices of these blocks, and what tables know of them on its way.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::name_vertices(
    const Blocks& blocks, std::size_t first, std::size_t end, Layer& layer,
    const BlockContours& contours) {
    layer.names.clear();
    for (std::size_t b = first; b < end; ++b) {
        const auto& contour = contours.at(static_cast<unsigned>(layer.signs[b]));
        std::size_t at = layer.names.size();
        layer.first_name[b] = at;
        layer.names.resize(at + contour.cut_count);
        for (const BlockContours::Cut& cut : contours.cuts(contour)) {
            const auto name =
                layer.number_of.name({blocks.key(b, cut.low), blocks.key(b, cut.high)});
            layer.names[at++] = name;
            const bool within = (blocks.faces(b, cut.low) & blocks.faces(b, cut.high)) == 0;
            if (!within) layer.number_of.prefetch(name);
        }
    }
}

/// Those of the ends entered which a level passes through.
/// \return how many
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_blocks(
    const Blocks& blocks, std::size_t first, std::size_t end, const std::uint8_t* entered) {
    const BlockContours& contours = BlockContours::of<Blocks::pattern>();
    const auto count_ends = [](unsigned bits) {  // at most 8 of them
        bits = (bits & 0x55U) + (bits >> 1U & 0x55U);
        bits = (bits & 0x33U) + (bits >> 2U & 0x33U);
        return (bits & 0xFU) + (bits >> 4U);
    };
    unsigned extracted = 0;
    for (Layer& layer : layers_) {
        set_signs(blocks, first, end, layer);
        if constexpr (indexed) name_vertices(blocks, first, end, layer, contours);
    }
    for (std::size_t b = first; b < end; ++b) {
        unsigned ends = 0;
        for (Layer& layer : layers_) {
            layer.contour = &contours.at(static_cast<unsigned>(layer.signs[b]));
            ends |= layer.contour->ends;
        }
        if (ends == 0) continue;
        bool plainly = (ends & ~entered[b]) == 0;
        if constexpr (indexed) plainly = plainly && blocks.boundary(b, 1) == 0;
        if (!plainly) {
            ends &= entered[b];
            for (unsigned left = ends; left != 0; left &= left - 1) {
                const auto part = static_cast<unsigned>(std::countr_zero(left));
                extract_part(blocks, b, Blocks::pattern.ends + part, Real(0));
            }
        } else {
            deepest_ = std::max(deepest_, blocks.level + static_cast<int>(Blocks::pattern.height));
            for (Layer& layer : layers_) draw_block(blocks, b, layer, contours);
        }
        extracted += count_ends(ends);
    }
    return extracted;
}

/// One element of a block, of which no more than its corners need be known.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_part(
    const Blocks& blocks, std::size_t b, std::size_t p, Real bound) {
    const auto& part = Blocks::pattern.part[p];
    const BlockContours& contours = BlockContours::of<Blocks::pattern>();
    const int level = blocks.level + part.depth;
    for (Layer& layer : layers_) {
        unsigned bits = 0;
        for (std::size_t i = 0; i < Blocks::pattern.corners; ++i) {
            bits |= unsigned{blocks.value(b, part.corner[i]) >= layer.least_inside} << i;
        }
        if (bits == 0 || bits + 1 == 1U << Blocks::pattern.corners) continue;
        layer_ = &layer;
        deepest_ = std::max(deepest_, level);
        layer.error_bound = std::max(layer.error_bound, static_cast<double>(bound));
        ++layer.extracted;
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(blocks.element(b, p), simplex_shape, level);
        }
        [[maybe_unused]] NodePositions<Blocks> x;
        if constexpr (!indexed) blocks.corner_positions(b, p, x);
        const BlockContours::Piece& piece = contours.piece(p, bits);
        const auto draw = [&](auto count) {
            std::array<BlockVertex, count> v;
            unrolled<count>([&](auto i) {
                if constexpr (indexed) {
                    const auto& [low, high] = piece.cut[i];
                    const auto name =
                        layer.number_of.name({blocks.key(b, low), blocks.key(b, high)});
                    v[i] = cut_in(blocks, b, layer, piece.cut[i], x, &name);
                } else {
                    v[i] = cut_in(blocks, b, layer, piece.cut[i], x, nullptr);
                }
            });
            count_simplices(count < 4 ? 1 : 2);
            put_loop(v, count, part.mirrored != blocks.mirrored(b));
            if constexpr (indexed) put_boundary(v, count, piece.face, blocks.boundary(b, p));
        };
        constexpr auto least = static_cast<std::size_t>(dimension);
        if (piece.count == least) {
            draw(std::integral_constant<std::size_t, least>{});
        } else {
            draw(std::integral_constant<std::size_t, 4>{});
        }
    }
}

/// All of the ends that a level passes through.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_block(
    const Blocks& blocks, std::size_t b, Layer& layer, const BlockContours& contours) {
    constexpr std::size_t nodes = Blocks::pattern.nodes;
    const BlockContours::Contour& contour = *layer.contour;
    layer_ = &layer;
    layer.extracted += contour.loop_count;
    count_simplices(contour.simplex_count);
    [[maybe_unused]] NodePositions<Blocks> x;
    if constexpr (!indexed) blocks.all_positions(b, x);
    std::array<BlockVertex, nodes*(nodes - 1) / 2> v;
    std::size_t count = 0;
    for (const BlockContours::Cut& cut : contours.cuts(contour)) {
        if constexpr (indexed) {
            v[count] = cut_in(blocks, b, layer, cut, x, &layer.names[layer.first_name[b] + count]);
        } else {
            v[count] = cut_in(blocks, b, layer, cut, x, nullptr);
        }
        ++count;
    }
    const int level = blocks.level + static_cast<int>(Blocks::pattern.height);
    for (const BlockContours::Loop& loop : contours.loops(contour)) {
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(blocks.element(b, Blocks::pattern.ends + loop.end),
                                   simplex_shape, level);
        }
        struct {
            const BlockVertex* vertex;
            const std::uint8_t* cut;
            NESTGRID_INLINE const BlockVertex& operator[](std::size_t i) const {
                return vertex[cut[i]];
            }
        } const corners{v.data(), loop.cut.data()};
        put_loop(corners, loop.count, (loop.mirrored != 0) != blocks.mirrored(b));
    }
}

/// The vertex on an edge of a block.
/// \param x positions of its ends, where there are no indices
/// \param name where there are
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::cut_in(
    const Blocks& blocks, std::size_t b, const Layer& layer, const BlockContours::Cut& ends,
    [[maybe_unused]] const NodePositions<Blocks>& x,
    [[maybe_unused]] const VertexNumbers::Name* name) -> BlockVertex {
    const std::size_t low = ends.low;
    const std::size_t high = ends.high;
    const auto fraction = [&] {
        return cut_fraction(layer.isovalue, static_cast<double>(blocks.value(b, low)),
                            static_cast<double>(blocks.value(b, high)));
    };
    if constexpr (indexed) {
        const SubtreeFaces faces = blocks.faces(b, low) & blocks.faces(b, high);
        return add_within(*name, faces, [&] {
            Cut cut{blocks.position(b, low),
                    {blocks.key(b, low), blocks.key(b, high)},
                    fraction(),
                    {}};
            cut.x = cut.x + cut.fraction * (blocks.position(b, high) - cut.x);
            return cut;
        });
    } else {
        return x[low] + fraction() * (x[high] - x[low]);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
