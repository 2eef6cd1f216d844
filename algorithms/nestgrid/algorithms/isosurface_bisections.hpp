// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Walks over bisections known at compile time; included by isosurface_steps.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface_visitor.hpp>

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
            PackedSight<Real> see_within(const PackedBlocks<Real>& blocks) override {
                return see<maubach_block<dimension>, BlockParts::inner>(blocks, *to);
            }
            PackedSight<Real> see_ends(const PackedBlocks<Real>& blocks) override {
                return see<maubach_block<dimension>, BlockParts::ends>(blocks, *to);
            }
            void expect(const NodeKey* nodes, std::size_t rows) const override {
                to->expect(nodes, rows);
            }
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
template <std::size_t around>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::glance(
    const PackedElements<Real, around>& e) -> PackedGlance<Real, around> {
    using Reals = Pack<Real>;
    using Mask = typename Reals::Mask;
    PackedGlance<Real, around> result;
    Mask holds;
    if constexpr (requires {
                      { packed_criterion_.holds(e.node, *indicator_, indicator_->look_up(e.node)) }
                          -> std::same_as<Mask>;
                  }) {
        const auto known = indicator_->look_up(e.node);
        result.bound = known.bound();
        holds = packed_criterion_.holds(e.node, *indicator_, known);
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
    const std::span<const Layer> layers(layers_);
    unrolled<around>([&](auto i) NESTGRID_INLINE_LAMBDA {
        const Reals& lo = e.range[i].first;
        const Reals& hi = e.range[i].second;
        const auto passes = [&](const Layer& layer) NESTGRID_INLINE_LAMBDA {
            return at_most(
                max(layer.packed_least_inside - hi, lo - layer.packed_greatest_outside),
                result.bound);
        };
        Mask interest = passes(layers[0]);
        for (const Layer& layer : layers.subspan(1)) interest = interest | passes(layer);
        result.descend[i] = without(interest, holds);
        result.stop[i] = interest & holds;
    });
    return result;
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Blocks>
unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract(
    const Blocks& blocks, const BatchSelection& selection) {
    return BlockDrawing<IsosurfaceVisitor, Blocks>(*this, blocks, selection).draw();
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
