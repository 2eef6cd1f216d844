// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that make and name the vertices of a surface.
#pragma once

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

template <int dimension, class Real, bool indexed>
KeyPair IsosurfaceVisitor<dimension, Real, indexed>::name(const View& s, std::uint8_t edge) const {
    if (const auto* maximal = s.closed.edge(edge)) return {maximal->key(0), maximal->key(1)};
    const auto& [a, b] = s.topology().edge[edge];
    return {key_[a], key_[b]};
}

/// The cut of the maximal edge of an edge, from its lower to its higher value.
template <int dimension, class Real, bool indexed>
SurfaceCut IsosurfaceVisitor<dimension, Real, indexed>::make_cut(const View& s, const Layer& layer,
                                                                 std::uint8_t edge) const {
    const auto* const maximal = s.closed.edge(edge);
    const auto& corner = s.topology().edge[edge];
    const auto value = [&](std::size_t end, std::size_t component) {
        return static_cast<double>(maximal != nullptr
                                       ? maximal->value(end, component)
                                       : s.value[corner[end] * components_ + component]);
    };
    const std::array<Point, 2> x =
        maximal != nullptr ? walk_->positions(*maximal) : std::array{x_[corner[0]], x_[corner[1]]};
    const auto key = [&](std::size_t end) {
        return maximal != nullptr ? maximal->key(end) : key_[corner[end]];
    };
    const std::size_t low = value(0, 0) >= layer.isovalue ? 1 : 0;
    const std::size_t high = 1 - low;
    Cut cut;
    cut.node = {key(low), key(high)};
    cut.fraction = cut_fraction(layer.isovalue, value(low, 0), value(high, 0));
    cut.x = x[low] + cut.fraction * (x[high] - x[low]);
    for (std::size_t i = 0; i < attribute_count_; ++i) {
        const double from = value(low, i + 1);
        attributes_[i] = from + cut.fraction * (value(high, i + 1) - from);
    }
    cut.attributes = attributes_;
    return cut;
}

template <int dimension, class Real, bool indexed>
SurfaceCut IsosurfaceVisitor<dimension, Real, indexed>::make_node(const View& s,
                                                                  std::size_t corner) const {
    for (std::size_t i = 0; i < attribute_count_; ++i) {
        attributes_[i] = static_cast<double>(s.value[corner * components_ + i + 1]);
    }
    return {x_[corner], {key_[corner], key_[corner]}, 0, attributes_};
}

/// The vertex with a name; make() says where it lies, where that is not known yet.
template <int dimension, class Real, bool indexed>
template <class Make>
NESTGRID_INLINE auto IsosurfaceVisitor<dimension, Real, indexed>::add(const KeyPair& name,
                                                                      Make&& make) -> Vertex {
    if constexpr (!indexed) {
        return make().x;
    } else {
        return add_named(layer_->number_of.name(name), make);
    }
}

/// The same with the name that it has in the table, where there is one.
template <int dimension, class Real, bool indexed>
template <class Make>
NESTGRID_INLINE auto IsosurfaceVisitor<dimension, Real, indexed>::add_named(
    [[maybe_unused]] const VertexName& name, Make&& make) -> Vertex {
    if constexpr (!indexed) {
        return make().x;
    } else {
        if (counts_only_) return add_new(make());
        Layer& layer = *layer_;
        bool is_new = false;
        const Number number = layer.number_of.find(name, [&] {
            is_new = true;
            return add_new(make());
        });
        if (options_->verify && !is_new) verify(layer, number, make().x);
        return number;
    }
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::verify(const Layer& layer, Number number,
                                                         const Point& x) const requires(indexed) {
    if (layer.sink.position(number) == x) return;
    throw GridError("two elements put the vertex " + std::to_string(number) +
                    " at different places");
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::add_new(const Cut& cut) -> Number {
    if (layer_->vertex_count == none) throw_too_many_vertices();
    if constexpr (indexed) {
        if (is_task_) {
            layer_->sink.add_shared(cut.node, cut.fraction, cut.x, cut.attributes);
            return layer_->vertex_count++;
        }
        layer_->sink.add_vertex(cut.x, cut.attributes);
    }
    if (options_->normals) {
        layer_->where.push_back(
            {gradients_.slot(cut.node[0]), gradients_.slot(cut.node[1]), cut.fraction, {}});
    }
    return layer_->vertex_count++;
}

/// A vertex inside one element.
template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::add_unnamed(const Point& x,
                                                              std::span<const double> attributes)
    -> Vertex {
    if constexpr (!indexed) {
        return x;
    } else {
        const Number number = layer_->vertex_count;
        add_unnamed(std::span(&x, 1), attributes);
        return number;
    }
}

/// Several, inside one element or known to one task alone.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_unnamed(std::span<const Point> x,
                                                              std::span<const double> attributes) {
    Layer& layer = *layer_;
    if (none - layer.vertex_count < x.size()) throw_too_many_vertices();
    layer.vertex_count += static_cast<Number>(x.size());
    if (options_->normals && !is_task_) {
        layer.where.resize(layer.where.size() + x.size(), {none, none, 0.0, {}});
    }
    if constexpr (indexed) layer.sink.add_vertices(x, attributes);
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::number_of(const Vertex& vertex,
                                                            const Point& reference) -> Number {
    local_.push_back(vertex);
    if (wants_reference()) reference_.push_back(reference);
    return static_cast<Number>(local_.size() - 1);
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::vertex(std::uint8_t edge) -> Number {
    if (on_edge_[edge] != none) return on_edge_[edge];
    const View& s = *state_;
    Point reference{};
    if (wants_reference()) {
        const Topology& t = s.topology();
        const auto& [a, b] = t.edge[edge];
        const double fraction = std::clamp(u_[a] / (u_[a] - u_[b]), 0.0, 1.0);
        reference = t.reference[a] + fraction * (t.reference[b] - t.reference[a]);
    }
    const auto make = [&] { return make_cut(s, *layer_, edge); };
    return on_edge_[edge] = number_of(add(name(s, edge), make), reference);
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::node_vertex(std::size_t corner) -> Number {
    if (on_corner_[corner] == none) {
        const auto make = [&] { return make_node(*state_, corner); };
        on_corner_[corner] = number_of(add({key_[corner], key_[corner]}, make),
                                       topology(state_->shape).reference[corner]);
    }
    return on_corner_[corner];
}

/// A vertex that a finer side recorded on a face of the element being drawn.
template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::recorded(Number index, const FaceTopology& face)
    -> Number {
    const Cut cut = layer_->drawn_below->cut(index);
    Point reference{};
    if (options_->reference) {
        // Newton's method on the map from the unit square (triangle) to the face.
        const Topology& t = topology(state_->shape);
        const auto blend = [&](const auto& of, double p, double q) {
            const auto at = [&](int i) { return of[face.tensor_corner(i)]; };
            if (face.corners == 3) return at(0) + p * (at(1) - at(0)) + q * (at(2) - at(0));
            return (1 - q) * ((1 - p) * at(0) + p * at(1)) + q * ((1 - p) * at(2) + p * at(3));
        };
        double p = 1.0 / 3;
        double q = 1.0 / 3;
        for (int step = 0; step < 20; ++step) {
            const Point rest = cut.x - blend(x_, p, q);
            const Point dp = blend(x_, p + 0.5, q) - blend(x_, p - 0.5, q);
            const Point dq = blend(x_, p, q + 0.5) - blend(x_, p, q - 0.5);
            const double pp = dot(dp, dp), pq = dot(dp, dq), qq = dot(dq, dq);
            const double determinant = pp * qq - pq * pq;
            if (determinant <= 0) break;
            p += (qq * dot(dp, rest) - pq * dot(dq, rest)) / determinant;
            q += (pp * dot(dq, rest) - pq * dot(dp, rest)) / determinant;
        }
        reference = blend(t.reference, p, q);
    }
    return number_of(add({cut.node[0], cut.node[1]}, [&] { return cut; }), reference);
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::chain(std::uint8_t edge) const
    -> std::span<const Number> {
    if ((chained_ >> edge & 1U) == 0) return {};
    return chain_[edge];
}

template <int dimension, class Real, bool indexed>
Point IsosurfaceVisitor<dimension, Real, indexed>::position(Number local) const {
    if constexpr (indexed) {
        return layer_->sink.position(local_[local]);
    } else {
        return local_[local];
    }
}

/// Attributes of the element at a point of its reference element.
template <int dimension, class Real, bool indexed>
std::span<const double> IsosurfaceVisitor<dimension, Real, indexed>::attributes_at(
    const Point& reference) const {
    if (attribute_count_ == 0) return {};
    std::ranges::fill(attributes_, 0.0);
    const auto weight = shape_functions(state_->shape, reference);
    for (std::size_t c = 0; c < state_->corner_count(); ++c) {
        for (std::size_t i = 0; i < attribute_count_; ++i) {
            attributes_[i] +=
                weight[c] * static_cast<double>(state_->value[c * components_ + i + 1]);
        }
    }
    return attributes_;
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::middle(std::span<const Number> of) -> Number {
    Point x{0, 0, 0};
    Point reference{0, 0, 0};
    const double weight = 1.0 / static_cast<double>(of.size());
    for (const Number v : of) {
        x = x + weight * position(v);
        if (wants_reference()) reference = reference + weight * reference_[v];
    }
    return number_of(add_unnamed(x, attributes_at(reference)), reference);
}

template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::inside(const Point& reference) -> Number {
    const auto weight = shape_functions(state_->shape, reference);
    Point x{0, 0, 0};
    for (std::size_t i = 0; i < state_->corner_count(); ++i) {
        x = x + weight[i] * x_[i];
    }
    return number_of(add_unnamed(x, attributes_at(reference)), reference);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::simplex(
    const std::array<Number, static_cast<std::size_t>(dimension)>& locals) {
    if (state_ != nullptr && !begun_) {
        layer_->sink.add_element(state_->element(), state_->shape, state_->level);
    }
    begun_ = true;
    const bool mirrored = state_ != nullptr && state_->orientation < 0;
    std::array<Vertex, static_cast<std::size_t>(dimension)> v;
    std::array<Point, static_cast<std::size_t>(dimension)> reference;
    for (std::size_t i = 0; i < locals.size(); ++i) {
        const std::size_t from = i < 2 && mirrored ? 1 - i : i;
        v[i] = local_[locals[from]];
        if (options_->reference) reference[i] = reference_[locals[from]];
    }
    count_simplices(1);
    put_simplex(v,
                options_->reference ? std::span<const Point>(reference) : std::span<const Point>());
}

template <int dimension, class Real, bool indexed>
NESTGRID_INLINE void IsosurfaceVisitor<dimension, Real, indexed>::put_simplex(
    const std::array<Vertex, static_cast<std::size_t>(dimension)>& v,
    std::span<const Point> reference) {
    layer_->sink.add_simplex(v, reference);
    if (options_->normals && !is_task_) add_area(v);
}

/// For normals.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_area(
    const std::array<Vertex, static_cast<std::size_t>(dimension)>& v) {
    if constexpr (indexed && dimension == 3) {
        const Point x = layer_->sink.position(v[0]);
        const Point n = cross(layer_->sink.position(v[1]) - x, layer_->sink.position(v[2]) - x);
        for (const Number i : v) layer_->where[i].around = layer_->where[i].around + n;
    }
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::triangle(Number a, Number b, Number c) {
    if constexpr (dimension == 3) simplex({a, b, c});
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_boundary(
    const std::array<Number, static_cast<std::size_t>(dimension - 1)>& locals) {
    if constexpr (indexed) {
        std::array<Number, static_cast<std::size_t>(dimension - 1)> v;
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = local_[locals[i]];
        layer_->sink.add_boundary(v);
    }
}

}  // namespace nestgrid::engine
