// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at nodes, and the normals at vertices that follow; included by isosurface_steps.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

/// Section 8: the gradient as a vector-valued function, projected with the same S.
NESTGRID_VISITOR::projected_gradient(const State& s, std::size_t corner) const -> Point {
    if ((s.interpolated >> corner & 1U) != 0 && s.father != nullptr) {
        const Child& child = s.made_by->children[s.child];
        return node_gradient(*s.father, *s.made_by, child.corner[corner]);
    }
    return own_gradients(s)[corner];
}

NESTGRID_VISITOR::own_gradients(const State& s) const -> std::array<Point, max_corners> {
    std::array<Point, max_corners> g{};
    if constexpr (offers_corner_gradients<Field, Context<Grid>, const ElementOf<Grid>&,
                                          std::span<Point>>) {
        call_corner_gradients(
            walk_->field(), *s.context, s.element,
            std::span<Point>(g.data(), static_cast<std::size_t>(s.corner_count())));
    }
    return g;
}

NESTGRID_VISITOR::node_gradient(const State& father, const Rule& rule, std::size_t node) const
    -> Point {
    const auto corners = static_cast<std::size_t>(father.corner_count());
    if (node < corners) return projected_gradient(father, node);
    const Stencil& stencil = rule.new_nodes[node - corners];
    std::array<Point, max_corners> parent;
    Stencil local = stencil;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        parent[i] = node_gradient(father, rule, stencil.parent[i]);
        local.parent[i] = static_cast<std::uint8_t>(i);
    }
    return interpolate(local, parent.data());
}

NESTGRID_VISITOR::load_gradients(const State& s) -> void {
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const bool own = offers_gradients<Grid, Field>(walk_->field());
    std::array<Point, max_corners> exact;  // asked for once, where a node is met for the first time
    bool asked = false;
    std::array<double, max_corners> value{};
    for (std::size_t i = 0; i < corners; ++i) value[i] = s.value[i * State::components];
    for (std::size_t i = 0; i < corners; ++i) {
        const Number slot = gradients_.slot(key_[i]);
        if (!own) {
            add_gradient(slot, corner_gradient(s.topology(), x_, value, i));
        } else if (!gradients_.known(slot)) {
            const bool interpolated = (s.interpolated >> i & 1U) != 0;
            if (!interpolated && !asked) {
                exact = own_gradients(s);
                asked = true;
            }
            add_gradient(slot, {interpolated ? projected_gradient(s, i) : exact[i], 1});
        }
    }
}

/// The field's own gradients are the same from every element, and added once.
NESTGRID_VISITOR::add_gradient(Number slot, const CornerGradient& g) -> void {
    if (gradients_.known(slot) && offers_gradients<Grid, Field>(walk_->field())) return;
    gradients_.add(slot, g);
    if (is_task_) gradient_log_.emplace_back(slot, g);
}

NESTGRID_VISITOR::set_normals(Layer& layer) -> void {
    for (Number v = 0; v < layer.where.size(); ++v) {
        const Where& w = layer.where[v];
        const bool low = w.low != none && gradients_.known(w.low);
        const bool high = w.high != none && gradients_.known(w.high);
        Point n = w.around;
        if (low || high) {
            const Point a = gradients_.mean(low ? w.low : w.high);
            const Point b = gradients_.mean(high ? w.high : w.low);
            const Point g = (1 - w.fraction) * a + w.fraction * b;
            if (norm(g) > 0) n = -1.0 * g;
        }
        const double length = norm(n);
        layer.sink.set_normal(v, length > 0 ? (1 / length) * n : n);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
