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
            using Base = ErasedBisectionVisitor<dimension, Real>;
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
            BlockGlance<Real, Base::interior> glance_within(
                const BlockInterior<Real, Base::interior>& elements) override {
                return to->glance_within(elements);
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

/// The same of each element within a block, without a branch.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Interior>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::glance_within(
    const Interior& e) -> typename Interior::Glance {
    constexpr std::size_t count = Interior::size;
    typename Interior::Glance result;
    unsigned interest = 0;
    for (std::size_t i = 0; i < count; ++i) {
        result.bound[i] = bound_of(std::span<const NodeKey>(&e.key[i], 1));
    }
    for (const Layer& layer : layers_) {
        for (std::size_t i = 0; i < count; ++i) {
            const bool below = layer.least_inside - e.hi[i] <= result.bound[i];
            const bool above = e.lo[i] - layer.greatest_outside <= result.bound[i];
            interest |= (unsigned{below} & unsigned{above}) << i;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const NodeMask mask = (*criterion_)(
            NewNodes{*e.rule[i], std::span<const NodeKey>(&e.key[i], 1), e.level[i] + 1, 0});
        result.stop |= unsigned{mask != 0} << i;
    }
    result.stop &= interest;
    result.descend = interest & ~result.stop;
    return result;
}

/// Those of the ends entered which a level passes through, one bit each.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_INLINE unsigned IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_block(
    const Block& block, unsigned entered) {
    constexpr std::size_t nodes = Block::pattern.nodes;
    const BlockContours& contours = BlockContours::of<Block::pattern>();
    const auto contour_of = [&](const Layer& layer) -> const BlockContours::Contour& {
        unsigned signs = 0;
        for (std::size_t i = 0; i < nodes; ++i) {
            signs |= unsigned{block.value[i] >= layer.least_inside} << i;
        }
        return contours.at(signs);
    };
    unsigned ends = 0;
    for (const Layer& layer : layers_) ends |= contour_of(layer).ends;
    if (ends == 0) return 0;
    bool plainly = (ends & ~entered) == 0;
    if constexpr (indexed) plainly = plainly && block.boundary(1) == 0;
    if (!plainly) {
        ends &= entered;
        for (unsigned left = ends; left != 0; left &= left - 1) {
            extract_part(block, Block::pattern.ends + static_cast<unsigned>(std::countr_zero(left)));
        }
        return ends;
    }
    deepest_ = std::max(deepest_, block.level + static_cast<int>(Block::pattern.height));
    for (Layer& layer : layers_) draw_block(block, layer, contours, contour_of(layer));
    return ends;
}

/// A leaf alone.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::extract_part(const Block& block,
                                                                      std::size_t p) {
    const auto& part = Block::pattern.part[p];
    Bisected s;
    s.element = block.element(p);
    for (std::size_t i = 0; i < Bisected::corners; ++i) {
        s.value[i] = block.value[part.corner[i]];
        x_[i] = block.position(part.corner[i]);
        if constexpr (indexed) key_[i] = block.node_key(part.corner[i]);
    }
    s.level = block.level + part.depth;
    s.orientation = part.mirrored ? -block.orientation : block.orientation;
    s.bound = 0;
    loaded_ = true;
    draw_bisected(s, [] {}, [&] { return block.boundary(p); });
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Block>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_block(
    const Block& block, Layer& layer, const BlockContours& contours,
    const BlockContours::Contour& contour) {
    constexpr std::size_t nodes = Block::pattern.nodes;
    constexpr std::size_t edges = nodes * (nodes - 1) / 2;
    layer_ = &layer;
    layer.extracted += static_cast<std::uint64_t>(std::popcount(contour.ends));
    [[maybe_unused]] std::array<Point, indexed ? 1 : nodes> x;
    if constexpr (!indexed) {
        for (std::size_t i = 0; i < nodes; ++i) x[i] = block.position(i);
    }
    std::array<Vertex, edges> v;
    std::size_t count = 0;
    for (const auto [low, high] : contours.cuts(contour)) {
        const auto fraction = [&] {
            return cut_fraction(layer.isovalue, static_cast<double>(block.value[low]),
                                static_cast<double>(block.value[high]));
        };
        if constexpr (indexed) {
            const KeyPair name{block.node_key(low), block.node_key(high)};
            v[count++] = add(name, [&] {
                Cut cut{block.position(low), {block.node_key(low), block.node_key(high)}, fraction(), {}};
                cut.x = cut.x + cut.fraction * (block.position(high) - cut.x);
                return cut;
            });
        } else {
            v[count++] = x[low] + fraction() * (x[high] - x[low]);
        }
    }
    const int level = block.level + static_cast<int>(Block::pattern.height);
    for (const BlockContours::Loop& loop : contours.loops(contour)) {
        if (keeps_elements(layer.sink)) {
            layer.sink.add_element(block.element(Block::pattern.ends + loop.end), simplex_shape,
                                   level);
        }
        const bool mirrored = (loop.mirrored != 0) != (block.orientation < 0);
        const auto put = [&](std::size_t a, std::size_t b, [[maybe_unused]] std::size_t c) {
            if (mirrored) std::swap(a, b);
            if constexpr (dimension == 2) {
                put_simplex({v[loop.cut[a]], v[loop.cut[b]]}, {});
            } else {
                put_simplex({v[loop.cut[a]], v[loop.cut[b]], v[loop.cut[c]]}, {});
            }
        };
        if (loop.count < 4) {
            put(0, 1, 2);
        } else {
            const auto position = [&](std::size_t i) {
                if constexpr (indexed) {
                    return layer.sink.position(v[loop.cut[i]]);
                } else {
                    return v[loop.cut[i]];
                }
            };
            const std::size_t a =
                shorter(position(0), position(2), position(1), position(3)) ? 0 : 1;
            put(a, a + 1, a + 2);
            put(a + 2, (a + 3) % 4, a);
        }
    }
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
