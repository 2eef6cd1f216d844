// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that sum up gradients at nodes, and make normals at vertices of
// them.
#pragma once

#include <levels/isosurface_visitor.hpp>
#include <nestgrid/interpolate.hpp>

namespace nestgrid::engine {

/// Section 8: the gradient as a vector-valued function, projected with the same S.
template <int dimension, class Real, bool indexed>
Point IsosurfaceVisitor<dimension, Real, indexed>::projected_gradient(const View& s,
                                                                      std::size_t corner) const {
    if ((s.interpolated >> corner & 1U) != 0 && s.father != nullptr) {
        const Child& child = s.made_by->children[s.child];
        return node_gradient(*s.father, *s.made_by, child.corner[corner]);
    }
    return own_gradients(s)[corner];
}

template <int dimension, class Real, bool indexed>
std::array<Point, max_corners> IsosurfaceVisitor<dimension, Real, indexed>::own_gradients(
    const View& s) const {
    std::array<Point, max_corners> g{};
    walk_->gradients(s, std::span(g).first(s.corner_count()));
    return g;
}

template <int dimension, class Real, bool indexed>
Point IsosurfaceVisitor<dimension, Real, indexed>::node_gradient(const View& father,
                                                                 const Rule& rule,
                                                                 std::size_t node) const {
    const auto corners = father.corner_count();
    if (node < corners) return projected_gradient(father, node);
    const Stencil& stencil = rule.new_nodes[node - corners];
    std::array<Point, max_corners> parent;
    Stencil local = stencil;
    for (std::size_t i = 0; i < stencil.count; ++i) {
        parent[i] = node_gradient(father, rule, stencil.parent[i]);
        local.parent[i] = static_cast<std::uint8_t>(i);
    }
    return detail::interpolate(local, parent.data());
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::load_gradients(const View& s) {
    const auto corners = s.corner_count();
    std::array<Point, max_corners> exact;  // asked for once, where a node is met for the first time
    bool asked = false;
    std::array<double, max_corners> value{};
    for (std::size_t i = 0; i < corners; ++i) value[i] = s.value[i * components_];
    for (std::size_t i = 0; i < corners; ++i) {
        const Number slot = gradients_.slot(key_[i]);
        if (!own_gradients_) {
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
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_gradient(Number slot,
                                                               const CornerGradient& g) {
    if (gradients_.known(slot) && own_gradients_) return;
    gradients_.add(slot, g);
    if (is_task_) gradient_log_.emplace_back(slot, g);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::set_normals(Layer& layer) requires(indexed) {
    std::vector<Point> normals;
    normals.reserve(layer.where.size());
    for (const Where& w : layer.where) {
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
        normals.push_back(length > 0 ? (1 / length) * n : n);
    }
    layer.sink.set_normals(std::move(normals));
}

}  // namespace nestgrid::engine
