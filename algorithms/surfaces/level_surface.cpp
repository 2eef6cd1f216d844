// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <surfaces/level_surface.hpp>

#include <numeric>
#include <string>

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
    extracted_ = 0;
    error_bound_ = 0;
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
    }
    return number;
}

template <int dimension>
auto LevelSurface<dimension>::add_unnamed(std::span<const Point> x,
                                          std::span<const double> attributes) -> Number {
    const Number first = builder_.next_vertex();
    if (none - first < x.size()) throw_too_many_vertices();
    if (gradients_ != nullptr) where_.resize(where_.size() + x.size(), {none, none, 0.0});
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
void LevelSurface<dimension>::add_part(const SurfacePart<dimension>& part) {
    const Surface<dimension>& surface = part.surface;
    if (!builder_.shares_vertices()) return builder_.hand_over(surface);
    constexpr std::size_t ahead = 16;
    const std::span<const Point> x(surface.vertices);
    const std::size_t stride = x.empty() ? 0 : surface.attributes.size() / x.size();
    const auto attributes = [&](std::size_t first, std::size_t end) {
        return std::span<const double>(surface.attributes)
            .subspan(first * stride, (end - first) * stride);
    };
    std::vector<Number> number;  // of each vertex of the part
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
    builder_.add_part(surface, number);
    if (gradients_ == nullptr) return;
    for (auto simplex : surface.simplices) {
        for (Number& v : simplex) v = number[v];
        add_area(simplex);
    }
}

/// Adds the area vector of a triangle to its corners, for vertices without a gradient.
template <int dimension>
void LevelSurface<dimension>::add_area(const Simplex& corners) {
    if constexpr (dimension == 3) {
        const Point x = position(corners[0]);
        const Point n = cross(position(corners[1]) - x, position(corners[2]) - x);
        for (const Number i : corners) where_[i].around = where_[i].around + n;
    }
}

template <int dimension>
Point LevelSurface<dimension>::normal(const Where& where) const {
    const bool low = where.low != none && gradients_->known(where.low);
    const bool high = where.high != none && gradients_->known(where.high);
    Point n = where.around;
    if (low || high) {
        const Point a = gradients_->mean(low ? where.low : where.high);
        const Point b = gradients_->mean(high ? where.high : where.low);
        const Point g = (1 - where.fraction) * a + where.fraction * b;
        if (norm(g) > 0) n = -1.0 * g;
    }
    const double length = norm(n);
    return length > 0 ? (1 / length) * n : n;
}

template <int dimension>
void LevelSurface<dimension>::set_normals() {
    if (gradients_ == nullptr) return;
    std::vector<Point> normals;
    normals.reserve(where_.size());
    for (const Where& where : where_) normals.push_back(normal(where));
    builder_.set_normals(std::move(normals));
}

template class LevelSurface<2>;
template class LevelSurface<3>;

}  // namespace nestgrid::engine
