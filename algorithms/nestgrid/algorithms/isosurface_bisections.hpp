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
            BlockGlance<Real, Erased::interior> glance_within(
                const BlockInterior<Real, Erased::interior>& elements) override {
                return to->glance_within(elements);
            }
            void extract_part(const ErasedBlock<dimension, Real>& block, std::size_t part,
                              Real bound) override {
                to->extract_part(block, part, bound);
            }
            void begin_subtree() override {
                if constexpr (indexed) to->begin_subtree();
            }
            unsigned extract_block(const ErasedBlock<dimension, Real>& block,
                                   unsigned entered) override {
                return to->extract_block(block, entered);
            }
            void tick(std::uint64_t calls, std::uint64_t visited) override {
                to->tick(calls, visited);
            }
            void end(std::uint64_t calls, std::uint64_t visited) override {
                to->count(calls, visited);
            }
        } erased(this);
        walk_->field().bisect(walk_->grid(), s.element, s.value.data(), s.level, s.orientation,
                              erased);
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

/// The same of each element within a block, without a branch.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Interior>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::glance_within(
    const Interior& e) -> typename Interior::Glance {
    constexpr std::size_t count = Interior::size;
    typename Interior::Glance result;
    unsigned interest = 0;
    unrolled<count>([&](auto i) NESTGRID_INLINE_LAMBDA {
        const std::span<const NodeKey> key(&e.key[i], 1);
        result.bound[i] = bound_of(key);
        const NodeMask mask = (*criterion_)(NewNodes{*e.rule[i], key, e.level[i] + 1, 0});
        result.stop |= unsigned{mask != 0} << i;
    });
    for (const Layer& layer : layers_) {
        unrolled<count>([&](auto i) NESTGRID_INLINE_LAMBDA {
            const Real off =
                std::max(layer.least_inside - e.hi[i], e.lo[i] - layer.greatest_outside);
            interest |= unsigned{off <= result.bound[i]} << i;
        });
    }
    result.stop &= interest;
    result.descend = interest & ~result.stop;
    return result;
}

/// Those of the ends entered which a level passes through.
/// \return how many
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_INLINE unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_block(
    const Block& block, unsigned entered) {
    const BlockContours& contours = BlockContours::of<Block::pattern>();
    const auto count_ends = [](unsigned bits) {  // at most 8 of them
        bits = (bits & 0x55U) + (bits >> 1U & 0x55U);
        bits = (bits & 0x33U) + (bits >> 2U & 0x33U);
        return (bits & 0xFU) + (bits >> 4U);
    };
    unsigned ends = 0;
    for (Layer& layer : layers_) {
        layer.contour = &contours.at(at_least(block.value, layer.least_inside));
        ends |= layer.contour->ends;
    }
    if (ends == 0) return 0;
    bool plainly = (ends & ~entered) == 0;
    if constexpr (indexed) plainly = plainly && block.boundary(1) == 0;
    if (!plainly) {
        ends &= entered;
        for (unsigned left = ends; left != 0; left &= left - 1) {
            const auto end = static_cast<unsigned>(std::countr_zero(left));
            extract_part(block, Block::pattern.ends + end, Real(0));
        }
        return count_ends(ends);
    }
    deepest_ = std::max(deepest_, block.level + static_cast<int>(Block::pattern.height));
    for (Layer& layer : layers_) draw_block(block, layer, contours);
    return count_ends(ends);
}

/// One element of a block, of which no more than its corners need be known.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_NOINLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_part(
    const Block& block, std::size_t p, Real bound) {
    const auto& part = Block::pattern.part[p];
    const BlockContours& contours = BlockContours::of<Block::pattern>();
    const int level = block.level + part.depth;
    for (Layer& layer : layers_) {
        unsigned bits = 0;
        for (std::size_t i = 0; i < Block::pattern.corners; ++i) {
            bits |= unsigned{block.value[part.corner[i]] >= layer.least_inside} << i;
        }
        if (bits == 0 || bits + 1 == 1U << Block::pattern.corners) continue;
        layer_ = &layer;
        deepest_ = std::max(deepest_, level);
        layer.error_bound = std::max(layer.error_bound, static_cast<double>(bound));
        ++layer.extracted;
        const BlockContours::Piece& piece = contours.piece(p, bits);
        [[maybe_unused]] NodePositions<Block> x;
        if constexpr (!indexed) {
            for (std::size_t i = 0; i < Block::pattern.corners; ++i) {
                x[part.corner[i]] = block.position(part.corner[i]);
            }
        }
        std::array<Vertex, 4> v;
        for (std::size_t i = 0; i < piece.count; ++i) v[i] = cut_in(block, layer, piece.cut[i], x);
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(block.element(p), simplex_shape, level);
        }
        put_loop(v, piece.count, part.mirrored != (block.orientation < 0));
        if constexpr (indexed) put_boundary(v, piece.count, piece.face, block.boundary(p));
    }
}

/// All of the ends that a level passes through.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_block(
    const Block& block, Layer& layer, const BlockContours& contours) {
    constexpr std::size_t nodes = Block::pattern.nodes;
    const BlockContours::Contour& contour = *layer.contour;
    layer_ = &layer;
    layer.extracted += contour.loop_count;
    [[maybe_unused]] NodePositions<Block> x;
    if constexpr (!indexed) block.all_positions(x);
    std::array<Vertex, nodes*(nodes - 1) / 2> v;
    std::size_t count = 0;
    for (const BlockContours::Cut& cut : contours.cuts(contour)) {
        v[count++] = cut_in(block, layer, cut, x);
    }
    const int level = block.level + static_cast<int>(Block::pattern.height);
    for (const BlockContours::Loop& loop : contours.loops(contour)) {
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(block.element(Block::pattern.ends + loop.end), simplex_shape,
                                   level);
        }
        const auto vertex = [&](std::size_t i) { return v[loop.cut[i]]; };
        const bool mirrored = (loop.mirrored != 0) != (block.orientation < 0);
        put_loop(std::array{vertex(0), vertex(1), vertex(2), vertex(3)}, loop.count, mirrored);
    }
}

/// The vertex on an edge of a block.
/// \param x positions of its ends, where there are no indices
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::cut_in(
    const Block& block, const Layer& layer, const BlockContours::Cut& ends,
    [[maybe_unused]] const NodePositions<Block>& x) -> Vertex {
    const std::size_t low = ends.low;
    const std::size_t high = ends.high;
    const auto fraction = [&] {
        return cut_fraction(layer.isovalue, static_cast<double>(block.value[low]),
                            static_cast<double>(block.value[high]));
    };
    if constexpr (indexed) {
        const KeyPair name{block.key[low], block.key[high]};
        const SubtreeFaces faces = block.faces[low] & block.faces[high];
        return add_within(name, faces, [&] {
            Cut cut{block.position(low), {block.key[low], block.key[high]}, fraction(), {}};
            cut.x = cut.x + cut.fraction * (block.position(high) - cut.x);
            return cut;
        });
    } else {
        return x[low] + fraction() * (x[high] - x[low]);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
