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
        struct Erased final : ErasedBisectionVisitor<Real> {
            using Base = ErasedBisectionVisitor<Real>;
            IsosurfaceVisitor* to;
            explicit Erased(IsosurfaceVisitor* visitor) : to{visitor} {}

            typename Base::Glance glance(Real lo, Real hi, const Rule& rule, NodeKey node,
                                         int level, bool outside) override {
                const auto [visit, bound] = to->glance(lo, hi, rule, node, level, outside);
                return {visit, bound};
            }
            bool glance_at_leaf(Real lo, Real hi) override { return to->glance_at_leaf(lo, hi); }
            void extract(const typename Base::Extracted& s) override {
                Bisected element;
                element.element = *s.element;
                std::copy_n(s.value, Bisected::corners, element.value.begin());
                element.level = s.level;
                element.orientation = s.orientation;
                element.bound = s.bound;
                std::copy_n(s.position, Bisected::corners, to->x_.begin());
                std::copy_n(s.key, Bisected::corners, to->key_.begin());
                to->loaded_ = true;
                to->draw_bisected(element, [] {}, [&] { return s.boundary; });
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

NESTGRID_VISITOR::extract(const Bisected& s) -> void {
    loaded_ = false;
    draw_bisected(
        s,
        [&] {
            walk_->grid().corner_positions(s.element, x_);
            if constexpr (indexed) walk_->grid().corner_keys(s.element, key_);
        },
        [&] { return walk_->grid().boundary_faces(s.element); });
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Load, class Boundary>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_bisected(
    const Bisected& s, const Load& load, const Boundary& boundary) {
    element_bound_ = s.bound;
    for (Layer& layer : layers_) {
        const unsigned bits = pattern(s.value.data(), Bisected::corners, layer);
        if (bits == 0 || bits + 1 == 1U << Bisected::corners) continue;
        deepest_ = std::max(deepest_, s.level);
        if (!loaded_) load();
        loaded_ = true;
        draw_plainly(s, simplex_shape, layer, plain_contour(simplex_shape, bits), bits, boundary);
        layer.error_bound = std::max(layer.error_bound, static_cast<double>(s.bound));
        ++layer.extracted;
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
