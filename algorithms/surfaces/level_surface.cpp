// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/level_surface.hpp>

#include <algorithm>
#include <numeric>
#include <string>

#include <surfaces/merge_at_nodes.hpp>

namespace nestgrid::engine {

template <int dimension>
void LevelSurface<dimension>::begin(Builder builder, NodeGradients* gradients, bool verify) {
    builder_ = std::move(builder);
    gradients_ = gradients;
    verifies_ = verify;
    counts_only_ = false;
    numbers_.clear();
    within_.begin_again(0);
    where_.clear();
    areas_.clear();
    at_nodes_.clear();
    is_at_node_.clear();
    sums_areas_ = gradients != nullptr && builder_.target() == nullptr;
    extracted_ = 0;
    error_bound_ = 0;
    position_bound_ = 0;
}

template <int dimension>
auto LevelSurface<dimension>::add(const SurfaceCut& cut) -> Number {
    const Number number = builder_.next_vertex();
    if (number == none) throw_too_many_vertices();
    if (builder_.lists_shared()) {
        builder_.add_shared(cut.node, cut.fraction, cut.x, cut.attributes);
        return number;
    }
    builder_.add_vertex(cut.x, cut.attributes);
    if (gradients_ != nullptr) {
        where_.push_back(
            {gradients_->slot(cut.node[0]), gradients_->slot(cut.node[1]), cut.fraction});
        if (sums_areas_) areas_.push_back({0, 0, 0});
    }
    return number;
}

template <int dimension>
auto LevelSurface<dimension>::add_unnamed(std::span<const Point> x,
                                          std::span<const double> attributes) -> Number {
    const Number first = builder_.next_vertex();
    if (none - first < x.size()) throw_too_many_vertices();
    if (gradients_ != nullptr) where_.resize(where_.size() + x.size(), {none, none, 0.0});
    if (sums_areas_) areas_.resize(areas_.size() + x.size(), {0, 0, 0});
    builder_.add_vertices(x, attributes);
    return first;
}

template <int dimension>
void LevelSurface<dimension>::verify(Number number, const Point& x) const {
    if (position(number) == x) return;
    throw GridError("two elements put the vertex " + std::to_string(number) +
                    " at different places");
}

template <int dimension>
void LevelSurface<dimension>::add_part(const SurfacePart<dimension>& part,
                                       const VerticesAtNodes& at_nodes) {
    const Surface<dimension>& surface = part.surface;
    if (!builder_.shares_vertices()) return builder_.hand_over(surface);
    constexpr std::size_t ahead = 16;
    const std::span<const Point> x(surface.vertices);
    const std::size_t stride = x.empty() ? 0 : surface.attributes.size() / x.size();
    const auto attributes = [&](std::size_t first, std::size_t end) {
        return std::span<const double>(surface.attributes)
            .subspan(first * stride, (end - first) * stride);
    };
    std::vector<Number> number;  // by vertex of the part: its number here
    number.reserve(x.size());
    const auto add_own = [&](std::size_t end) {
        const std::size_t first = number.size();
        if (first == end) return;
        const Number next = add_unnamed(x.subspan(first, end - first), attributes(first, end));
        number.resize(end);
        std::iota(number.data() + first, number.data() + end, next);
    };
    const auto name_of = [&](const SharedVertex& v) { return name({v.node[0], v.node[1]}); };
    for (std::size_t i = 0; i < part.shared.size(); ++i) {
        if (i + ahead < part.shared.size()) prefetch(name_of(part.shared[i + ahead]));
        const SharedVertex& v = part.shared[i];
        add_own(v.number);
        number.push_back(vertex(name_of(v), [&] {
            return SurfaceCut{x[v.number], v.node, v.fraction,
                              attributes(v.number, v.number + std::size_t{1})};
        }));
    }
    add_own(x.size());
    for (auto ridge : surface.boundary) {
        for (Number& v : ridge) v = number[v];
        builder_.add_boundary(ridge);
    }
    for (std::size_t i = 0; i < at_nodes.vertex.size(); ++i) {
        put_at_node(number[at_nodes.vertex[i]], at_nodes.node[i],
                    std::span(at_nodes.attributes).subspan(i * stride, stride));
    }
    builder_.add_part(surface, number);
    if (!sums_areas_) return;
    for (auto simplex : surface.simplices) {
        for (Number& v : simplex) v = number[v];
        sum_area(simplex);
    }
}

/// Twice the area vector of a triangle; 0 in two dimensions.
template <int dimension>
Point LevelSurface<dimension>::area(const Simplex& corners) const {
    if constexpr (dimension == 2) return {0, 0, 0};
    const Point x = position(corners[0]);
    return cross(position(corners[1]) - x, position(corners[dimension - 1]) - x);
}

/// The gradient at a vertex, interpolated between its nodes; 0 where neither node has a gradient.
template <int dimension>
Point LevelSurface<dimension>::gradient_at(const Where& where) const {
    const bool low = where.low != none && gradients_->known(where.low);
    const bool high = where.high != none && gradients_->known(where.high);
    if (!low && !high) return {0, 0, 0};
    const Point a = gradients_->mean(low ? where.low : where.high);
    const Point b = gradients_->mean(high ? where.high : where.low);
    return (1 - where.fraction) * a + where.fraction * b;
}

/// Adds to the normal of each flat vertex the area vectors of the triangles around the vertex.
template <int dimension>
void LevelSurface<dimension>::add_areas(const std::vector<bool>& flat,
                                        std::vector<Point>& normals) const {
    for (std::size_t v = 0; sums_areas_ && v < flat.size(); ++v) {
        if (flat[v]) normals[v] = areas_[v];
    }
    if (sums_areas_) return;
    for (const Simplex& simplex : builder_.target()->simplices) {
        if (std::ranges::none_of(simplex, [&](Number v) { return flat[v]; })) continue;
        const Point n = area(simplex);
        for (const Number v : simplex) {
            if (flat[v]) normals[v] = normals[v] + n;
        }
    }
}

template <int dimension>
void LevelSurface<dimension>::set_normals() {
    if (gradients_ == nullptr) return;
    std::vector<Point> normals;
    normals.reserve(where_.size());
    std::vector<bool> flat;  // vertices without a gradient
    flat.reserve(where_.size());
    for (const Where& where : where_) {
        const Point g = gradient_at(where);
        flat.push_back(!(norm(g) > 0));
        normals.push_back(flat.back() ? Point{0, 0, 0} : -1.0 * g);
    }
    if (std::ranges::find(flat, true) != flat.end()) add_areas(flat, normals);
    for (Point& n : normals) {
        const double length = norm(n);
        if (length > 0) n = (1 / length) * n;
    }
    builder_.set_normals(std::move(normals));
}

template <>
void LevelSurface<2>::merge_at_nodes() {}
template <>
void LevelSurface<3>::merge_at_nodes() {
    builder_.change([&](Surface<3>& surface) { engine::merge_at_nodes(surface, at_nodes_); });
}

template class LevelSurface<2>;
template class LevelSurface<3>;

}  // namespace nestgrid::engine
