// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor for walks over bisections in blocks.
#pragma once

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

/// Carries the questions of a walk in blocks from the grid's side of the seam to a visitor.
template <int dimension, class Real, class Visitor>
class BlockSeam final : public detail::ErasedBisectionVisitor<dimension, Real> {
    using Base = detail::ErasedBisectionVisitor<dimension, Real>;

public:
    explicit BlockSeam(Visitor& visitor) : to_{&visitor} {}

    typename Base::Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node, int level,
                                 bool outside) override {
        const auto [visit, bound] = to_->glance(lo, hi, rule, node, level, outside);
        return {visit, bound};
    }
    bool glance_at_leaf(Real lo, Real hi) override { return to_->glance_at_leaf(lo, hi); }
    PackedSight<Real> see_within(const PackedBlocks<Real>& blocks) override {
        return see<maubach_block<dimension>, BlockParts::inner>(blocks, *to_);
    }
    PackedSight<Real> see_ends(const PackedBlocks<Real>& blocks) override {
        return see<maubach_block<dimension>, BlockParts::ends>(blocks, *to_);
    }
    void expect(const NodeKey* nodes, std::size_t rows) const override { to_->expect(nodes, rows); }
    bool names_edges() const override { return to_->names_edges(); }
    void begin_subtrees(std::uint32_t numbers) override { to_->begin_subtrees(numbers); }
    unsigned extract(const detail::ErasedBlocks<dimension, Real>& blocks,
                     const BatchSelection& selection) override {
        return to_->extract(blocks, selection);
    }
    void tick(std::uint64_t calls, std::uint64_t visited) override { to_->tick(calls, visited); }
    void end(std::uint64_t calls, std::uint64_t visited) override { to_->count(calls, visited); }

private:
    Visitor* to_;
};

template <int dimension, class Real, bool indexed>
bool IsosurfaceVisitor<dimension, Real, indexed>::takes(const View& s) {
    if (!bisects_) return false;
    BlockSeam<dimension, Real, IsosurfaceVisitor> seam(*this);
    walk_->hierarchy().bisect(s.stack->task.get(), s.element(), s.value, s.level, s.orientation,
                              seam);
    return true;
}

template <int dimension, class Real, bool indexed>
NESTGRID_INLINE auto IsosurfaceVisitor<dimension, Real, indexed>::glance(Real lo, Real hi,
                                                                         const Rule& rule,
                                                                         NodeKey node, int level,
                                                                         bool outside) -> Glance {
    const std::span<const NodeKey> keys(&node, 1);
    const Real bound = bound_of(rule, keys);
    if (!of_interest(lo, hi, bound, false)) return {Visit::skip, bound};
    const NodeMask mask = holds({rule, keys, level + 1, outside ? NodeMask{1} : NodeMask{0}});
    return {mask != 0 ? Visit::stop : Visit::descend, bound};
}

/// The same of eight, without a branch.
template <int dimension, class Real, bool indexed>
template <std::size_t around>
NESTGRID_INLINE auto IsosurfaceVisitor<dimension, Real, indexed>::glance(
    const PackedElements<Real, around>& e) -> PackedGlance<Real, around> {
    using Reals = Pack<Real>;
    using Mask = typename Reals::Mask;
    PackedGlance<Real, around> result;
    Mask holds;
    bool is_known = false;
    if constexpr (std::is_same_v<Real, float>) {
        is_known = own_threshold_ != nullptr;
        if (is_known) {
            const PackedEntries known = look_up(*entries_, e.node);
            result.bound = known.bound();
            holds = at_most(known.stop(), packed_threshold_);
        }
    }
    if (!is_known) {
        const auto key = [&](auto i) NESTGRID_INLINE_LAMBDA {
            return std::span<const NodeKey>(e.node + i, 1);
        };
        result.bound =
            Reals::make([&](auto i) NESTGRID_INLINE_LAMBDA { return bound_of(e.rule, key(i)); });
        holds = Mask::make([&](auto i) NESTGRID_INLINE_LAMBDA {
            const NodeMask mask = this->holds({e.rule, key(i), e.level + 1, 0});
            return mask != 0 ? ~MaskOf<Real>{0} : MaskOf<Real>{0};
        });
    }
    const std::span<const Layer> layers(layers_);
    unrolled<around>([&](auto i) NESTGRID_INLINE_LAMBDA {
        const Reals& lo = e.range[i].first;
        const Reals& hi = e.range[i].second;
        const auto passes = [&](const Layer& layer) NESTGRID_INLINE_LAMBDA {
            return at_most(max(layer.packed_least_inside - hi, lo - layer.packed_greatest_outside),
                           result.bound);
        };
        Mask interest = passes(layers[0]);
        for (const Layer& layer : layers.subspan(1)) interest = interest | passes(layer);
        result.descend[i] = without(interest, holds);
        result.stop[i] = interest & holds;
    });
    return result;
}

template <int dimension, class Real, bool indexed>
template <class Blocks>
unsigned IsosurfaceVisitor<dimension, Real, indexed>::extract(const Blocks& blocks,
                                                              const BatchSelection& selection) {
    return BlockDrawing<IsosurfaceVisitor, Blocks>(*this, blocks, selection).draw();
}

}  // namespace nestgrid::engine
