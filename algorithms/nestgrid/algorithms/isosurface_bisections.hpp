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
            bool extract_part(const ErasedBlocks<dimension, Real>& blocks, std::size_t b,
                              std::size_t part, Real bound) override {
                return to->extract_part(blocks, b, part, bound);
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
    for (Layer& layer : layers_) set_signs(blocks, first, end, layer);
    const auto draw_until = [&](std::size_t b) {
        for (Layer& layer : layers_) draw_blocks(blocks, first, b, layer, contours);
    };
    unsigned extracted = 0;
    for (std::size_t b = first; b < end; ++b) {
        unsigned ends = 0;
        for (const Layer& layer : layers_) {
            ends |= contours.at(static_cast<unsigned>(layer.signs[b])).ends;
        }
        bool plainly = (ends & ~entered[b]) == 0;
        if constexpr (indexed) plainly = plainly && (ends == 0 || blocks.boundary(b, 1) == 0);
        if (!plainly) {
            draw_until(b);
            first = b + 1;
            ends &= entered[b];
            for (unsigned left = ends; left != 0; left &= left - 1) {
                const auto part = static_cast<unsigned>(std::countr_zero(left));
                extract_part(blocks, b, Blocks::pattern.ends + part, Real(0));
            }
        }
        extracted += count_ends(ends);
    }
    draw_until(end);
    return extracted;
}

/// One element of a block, of which no more than its corners need be known.
/// \return whether a level passes through it
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_NOINLINE bool IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_part(
    const Blocks& blocks, std::size_t b, std::size_t p, Real bound) {
    constexpr std::size_t corners = Blocks::pattern.corners;
    const auto& part = Blocks::pattern.part[p];
    const BlockContours& contours = BlockContours::of<Blocks::pattern>();
    const int level = blocks.level + part.depth;
    std::array<Real, corners> u;
    unrolled<corners>([&](auto i) NESTGRID_INLINE_LAMBDA {
        u[i] = blocks.value(b, part.corner[i]);
    });
    bool any = false;
    for (Layer& layer : layers_) {
        unsigned bits = 0;
        unrolled<corners>([&](auto i) NESTGRID_INLINE_LAMBDA {
            bits |= unsigned{u[i] >= layer.least_inside} << i;
        });
        if (bits == 0 || bits + 1 == 1U << corners) continue;
        any = true;
        layer_ = &layer;
        deepest_ = std::max(deepest_, level);
        layer.error_bound = std::max(layer.error_bound, static_cast<double>(bound));
        ++layer.extracted;
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(blocks.element(b, p), simplex_shape, level);
        }
        [[maybe_unused]] std::array<WidePoint, corners> x;
        if constexpr (!indexed) blocks.corner_positions(b, p, x);
        const BlockContours::Piece& piece = contours.piece(bits);
        const auto draw = [&](auto count) {
            std::array<BlockVertex, count> v;
            unrolled<count>([&](auto i) {
                const auto& [low, high] = piece.cut[i];
                if constexpr (indexed) {
                    const std::size_t from = part.corner[low];
                    const std::size_t to = part.corner[high];
                    const auto name =
                        layer.number_of.name({blocks.key(b, from), blocks.key(b, to)});
                    v[i] = number_in(blocks, b, layer, from, to, name);
                } else {
                    v[i] = x[low] + fraction(layer, u[low], u[high]) * (x[high] - x[low]);
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
    return any;
}

/// All ends of blocks first ... end - 1 that a level passes through.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_blocks(
    const Blocks& blocks, std::size_t first, std::size_t end, Layer& layer,
    const BlockContours& contours) {
    using Run = BlockContourRun<Blocks::pattern, most_blocks>;
    Run run;
    [[maybe_unused]] std::array<std::array<WidePoint, Blocks::pattern.nodes>,
                                indexed ? 1 : most_blocks>
        x;
    for (std::size_t b = first; b < end; ++b) {
        const auto& contour = contours.at(static_cast<unsigned>(layer.signs[b]));
        if (contour.loop_count == 0) continue;
        run.append(contours, contour, b);
        if constexpr (!indexed) blocks.all_positions(b, x[b]);
    }
    if (run.loop_count == 0) return;
    layer_ = &layer;
    const int level = blocks.level + static_cast<int>(Blocks::pattern.height);
    deepest_ = std::max(deepest_, level);
    layer.extracted += run.loop_count;
    count_simplices(run.simplex_count);

    std::array<BlockVertex, Run::most_cuts> v;
    if constexpr (indexed) {
        const std::array<const VertexNumbers*, 2> table{&layer.number_of, &layer.number_within};
        std::array<VertexNumbers::Name, Run::most_cuts> names;
        for (std::size_t i = 0; i < run.cut_count; ++i) {
            const std::size_t b = run.block_of_cut(i);
            const auto& [low, high] = run.cut(i);
            names[i] = layer.number_of.name({blocks.key(b, low), blocks.key(b, high)});
            const bool within = is_within_subtree(blocks.faces(b, low) & blocks.faces(b, high));
            table[within ? 1 : 0]->prefetch(names[i]);
        }
        for (std::size_t i = 0; i < run.cut_count; ++i) {
            const auto& [low, high] = run.cut(i);
            v[i] = number_in(blocks, run.block_of_cut(i), layer, low, high, names[i]);
        }
    } else {
        for (std::size_t i = 0; i < run.cut_count; ++i) {
            const std::size_t b = run.block_of_cut(i);
            const auto& [low, high] = run.cut(i);
            const double part = fraction(layer, blocks.value(b, low), blocks.value(b, high));
            v[i] = x[b][low] + part * (x[b][high] - x[b][low]);
        }
    }

    for (std::size_t i = 0; i < run.loop_count; ++i) {
        const std::size_t b = run.block_of_loop(i);
        const BlockContours::Loop& loop = run.loop(i);
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(blocks.element(b, Blocks::pattern.ends + loop.end),
                                   simplex_shape, level);
        }
        struct {
            const BlockVertex* vertex;
            const std::uint8_t* cut;
            NESTGRID_INLINE const BlockVertex& operator[](std::size_t k) const {
                return vertex[cut[k]];
            }
        } const corners{v.data() + run.first_cut(i), loop.cut.data()};
        put_loop(corners, loop.count, (loop.mirrored != 0) != blocks.mirrored(b));
    }
}

/// The vertex between two nodes of a block.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::number_in(
    const Blocks& blocks, std::size_t b, const Layer& layer, std::size_t low, std::size_t high,
    const VertexNumbers::Name& name) -> Number {
    const SubtreeFaces faces = blocks.faces(b, low) & blocks.faces(b, high);
    return add_within(name, faces, [&] {
        Cut cut{blocks.position(b, low),
                {blocks.key(b, low), blocks.key(b, high)},
                fraction(layer, blocks.value(b, low), blocks.value(b, high)),
                {}};
        cut.x = cut.x + cut.fraction * (blocks.position(b, high) - cut.x);
        return cut;
    });
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
