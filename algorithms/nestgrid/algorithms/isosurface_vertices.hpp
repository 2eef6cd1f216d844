// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices of the surface; included by isosurface_steps.hpp.
#pragma once

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

NESTGRID_VISITOR::name(const State& s, std::uint8_t edge) const -> KeyPair {
    if (const auto* maximal = s.closed.edge(edge)) return {maximal->key(0), maximal->key(1)};
    const auto& [a, b] = s.topology().edge[edge];
    return {key_[a], key_[b]};
}

/// The cut of the maximal edge of an edge, from its lower to its higher value.
NESTGRID_VISITOR::make_cut(const State& s, const Layer& layer, std::uint8_t edge) const -> Cut {
    constexpr std::size_t stride = State::components;
    std::array<Point, 2> x;
    std::array<std::array<double, stride>, 2> value;
    Cut cut;
    if (const auto* maximal = s.closed.edge(edge)) {
        x = walk_->positions(*maximal);
        for (std::size_t end = 0; end < 2; ++end) {
            cut.node[end] = maximal->key(end);
            for (std::size_t i = 0; i < stride; ++i) {
                value[end][i] = static_cast<double>(maximal->value(end, i));
            }
        }
    } else {
        for (std::size_t end = 0; end < 2; ++end) {
            const std::size_t c = s.topology().edge[edge][end];
            x[end] = x_[c];
            cut.node[end] = key_[c];
            for (std::size_t i = 0; i < stride; ++i) {
                value[end][i] = static_cast<double>(s.value[c * stride + i]);
            }
        }
    }
    if (value[0][0] >= layer.isovalue) {
        std::swap(x[0], x[1]);
        std::swap(value[0], value[1]);
        std::swap(cut.node[0], cut.node[1]);
    }
    cut.fraction = cut_fraction(layer.isovalue, value[0][0], value[1][0]);
    cut.x = x[0] + cut.fraction * (x[1] - x[0]);
    for (std::size_t i = 1; i < stride; ++i) {
        cut.attributes[i - 1] = value[0][i] + cut.fraction * (value[1][i] - value[0][i]);
    }
    return cut;
}

NESTGRID_VISITOR::make_node(const State& s, std::size_t corner) const -> Cut {
    Cut cut{x_[corner], {key_[corner], key_[corner]}, 0, {}};
    for (std::size_t i = 0; i < attribute_count; ++i) {
        cut.attributes[i] = static_cast<double>(s.value[corner * State::components + i + 1]);
    }
    return cut;
}

/// The vertex with a name; make() says where it lies, where that is not known yet.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Make>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::add(const KeyPair& name,
                                                                            Make&& make) -> Vertex {
    if constexpr (!indexed) {
        return make().x;
    } else {
        return add_named(layer_->number_of.name(name), make);
    }
}

/// The same with the name that it has in the table, where there is one.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Make>
NESTGRID_INLINE auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::add_named(
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

NESTGRID_VISITOR::verify(const Layer& layer, Number number, const Point& x) const -> void {
    if (layer.sink.position(number) == x) return;
    throw GridError("two elements put the vertex " + std::to_string(number) +
                    " at different places");
}

NESTGRID_VISITOR::add_new(const Cut& cut) -> Number {
    if (layer_->vertex_count == none) throw_too_many_vertices();
    if (is_task_) {
        if constexpr (may_be_task) {
            layer_->sink.add_shared(cut.node, cut.fraction, cut.x, cut.attributes);
        }
        return layer_->vertex_count++;
    }
    layer_->sink.add_vertex(cut.x, cut.attributes);
    if (options_->normals) {
        layer_->where.push_back(
            {gradients_.slot(cut.node[0]), gradients_.slot(cut.node[1]), cut.fraction, {}});
    }
    return layer_->vertex_count++;
}

/// A vertex inside one element.
NESTGRID_VISITOR::add_unnamed(const Point& x, std::span<const double> attributes) -> Vertex {
    if constexpr (!indexed) {
        return x;
    } else {
        const Number number = layer_->vertex_count;
        add_unnamed(std::span(&x, 1), attributes);
        return number;
    }
}

/// Several, inside one element or known to one task alone.
NESTGRID_VISITOR::add_unnamed(std::span<const Point> x, std::span<const double> attributes)
    -> void {
    Layer& layer = *layer_;
    if (none - layer.vertex_count < x.size()) throw_too_many_vertices();
    layer.vertex_count += static_cast<Number>(x.size());
    if (options_->normals && !is_task_) {
        layer.where.resize(layer.where.size() + x.size(), {none, none, 0.0, {}});
    }
    if constexpr (attribute_count == 0 && requires { layer.sink.add_vertices(x); }) {
        layer.sink.add_vertices(x);
    } else {
        for (std::size_t i = 0; i < x.size(); ++i) {
            layer.sink.add_vertex(x[i], attributes.subspan(i * attribute_count, attribute_count));
        }
    }
}

NESTGRID_VISITOR::number_of(const Vertex& vertex, const Point& reference) -> Number {
    local_.push_back(vertex);
    if (wants_reference()) reference_.push_back(reference);
    return static_cast<Number>(local_.size() - 1);
}

NESTGRID_VISITOR::vertex(std::uint8_t edge) -> Number {
    if (on_edge_[edge] != none) return on_edge_[edge];
    const State& s = *state_;
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

NESTGRID_VISITOR::node_vertex(std::size_t corner) -> Number {
    if (on_corner_[corner] == none) {
        const auto make = [&] { return make_node(*state_, corner); };
        on_corner_[corner] = number_of(add({key_[corner], key_[corner]}, make),
                                       topology(state_->shape).reference[corner]);
    }
    return on_corner_[corner];
}

/// A vertex that a finer side recorded on a face of the element being drawn.
NESTGRID_VISITOR::recorded(Number index, const FaceTopology& face) -> Number {
    const Cut& cut = layer_->drawn_below->cut(index);
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

NESTGRID_VISITOR::chain(std::uint8_t edge) const -> std::span<const Number> {
    if ((chained_ >> edge & 1U) == 0) return {};
    return chain_[edge];
}

NESTGRID_VISITOR::position(Number local) const -> Point {
    if constexpr (indexed) {
        return layer_->sink.position(local_[local]);
    } else {
        return local_[local];
    }
}

/// Of the element at a point of its reference element.
NESTGRID_VISITOR::attributes_at(const Point& reference) const
    -> std::array<double, attribute_count> {
    std::array<double, attribute_count> attributes{};
    if constexpr (attribute_count > 0) {
        const auto weight = shape_functions(state_->shape, reference);
        for (std::size_t c = 0; c < static_cast<std::size_t>(state_->corner_count()); ++c) {
            for (std::size_t i = 0; i < attribute_count; ++i) {
                attributes[i] += weight[c] * static_cast<double>(
                                                 state_->value[c * State::components + i + 1]);
            }
        }
    }
    return attributes;
}

NESTGRID_VISITOR::middle(std::span<const Number> of) -> Number {
    Point x{0, 0, 0};
    Point reference{0, 0, 0};
    const double weight = 1.0 / static_cast<double>(of.size());
    for (const Number v : of) {
        x = x + weight * position(v);
        if (wants_reference()) reference = reference + weight * reference_[v];
    }
    return number_of(add_unnamed(x, attributes_at(reference)), reference);
}

NESTGRID_VISITOR::inside(const Point& reference) -> Number {
    const auto weight = shape_functions(state_->shape, reference);
    Point x{0, 0, 0};
    for (std::size_t i = 0; i < static_cast<std::size_t>(state_->corner_count()); ++i) {
        x = x + weight[i] * x_[i];
    }
    return number_of(add_unnamed(x, attributes_at(reference)), reference);
}

NESTGRID_VISITOR::simplex(const std::array<Number, static_cast<std::size_t>(dimension)>& locals)
    -> void {
    if (state_ != nullptr && !begun_) {
        layer_->sink.add_element(state_->element, state_->shape, state_->level);
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
    put_simplex(v, options_->reference ? std::span<const Point>(reference)
                                       : std::span<const Point>());
}

template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_simplex(
    const std::array<Vertex, static_cast<std::size_t>(dimension)>& v,
    std::span<const Point> reference) {
    layer_->sink.add_simplex(v, reference);
    if (options_->normals && !is_task_) add_area(v);
}

/// For normals.
NESTGRID_VISITOR::add_area(const std::array<Vertex, static_cast<std::size_t>(dimension)>& v)
    -> void {
    if constexpr (indexed && dimension == 3) {
        const Point x = layer_->sink.position(v[0]);
        const Point n = cross(layer_->sink.position(v[1]) - x, layer_->sink.position(v[2]) - x);
        for (const Number i : v) layer_->where[i].around = layer_->where[i].around + n;
    }
}

NESTGRID_VISITOR::triangle(Number a, Number b, Number c) -> void {
    if constexpr (dimension == 3) simplex({a, b, c});
}

NESTGRID_VISITOR::add_boundary(
    const std::array<Number, static_cast<std::size_t>(dimension - 1)>& locals) -> void {
    if constexpr (indexed) {
        std::array<Number, static_cast<std::size_t>(dimension - 1)> v;
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = local_[locals[i]];
        layer_->sink.add_boundary(v);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
