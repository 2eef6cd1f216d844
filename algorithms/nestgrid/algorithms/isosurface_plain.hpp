// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drawing elements of which nothing is special; included by isosurface_steps.hpp.
//
// That is: no finer side drew on a face of theirs, no signs on a face alternate, no loop is filled
// around its middle, and nothing but vertices and triangles is asked for. Most elements are like
// that, and what is drawn of them, and in which order, is what draw() draws, to the last bit.
#pragma once

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

/// The table of a shape, which is made when it is met.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE const ContourTable&
IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::contours_of(Shape shape) {
    const ContourTable*& table = table_[static_cast<std::size_t>(shape)];
    if (table == nullptr) table = &ContourTable::of(shape);
    return *table;
}

/// The contour of a sign pattern, where it is plain; else null.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE const Contour* IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::plain_contour(
    Shape shape, unsigned bits) {
    return contours_of(shape).plain(bits);
}

/// How many triangles (segments) a loop without a vertex in its middle is drawn as.
NESTGRID_VISITOR::simplices_of(const ContourLoop& loop) -> std::size_t {
    return loop.count <= 3 ? 1 : std::size_t{loop.count} - 2;
}

/// The same of a plain contour.
NESTGRID_VISITOR::simplices_of(const Contour& contour) -> std::size_t {
    std::size_t count = 0;
    for (std::size_t l = 0; l < contour.loop_count; ++l) count += simplices_of(contour.loop[l]);
    return count;
}

/// Draws a plain contour; positions (and keys) of the corners are loaded.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_plainly(
    const State& s, Layer& layer, const Contour* contour, unsigned bits) {
    constexpr bool simplices = State::capacity == static_cast<std::size_t>(dimension) + 1;
    layer_ = &layer;
    const Topology& t = s.topology();
    const bool mirrored = s.orientation < 0;
    const std::size_t loops = simplices ? 1 : contour->loop_count;
    for (std::size_t l = 0; l < loops; ++l) {
        const ContourLoop& loop = contour->loop[l];
        const std::size_t n = loop.count;
        std::array<Vertex, simplices ? 4 : max_edges> v;
        std::array<VertexName, simplices ? 4 : max_edges> names;
        if constexpr (indexed) {  // all of a loop, so that none waits for another one's slot
            for (std::size_t i = 0; i < n; ++i) {
                names[i] = layer.number_of.name(name(s, loop.edge[i]));
                layer.number_of.prefetch(names[i]);
            }
        }
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint8_t edge = loop.edge[i];
            if (s.closed.edge(edge) != nullptr) {
                v[i] = add_closed(s, edge, names[i]);
                continue;
            }
            const auto& [a, b] = t.edge[edge];
            const bool falls = (bits >> a & 1U) != 0;
            const std::size_t low = falls ? b : a;
            const std::size_t high = falls ? a : b;
            const auto make = [&] {
                Cut cut;
                cut.fraction = cut_fraction(layer.isovalue,
                                            static_cast<double>(s.value[low * State::components]),
                                            static_cast<double>(s.value[high * State::components]));
                cut.x = x_[low] + cut.fraction * (x_[high] - x_[low]);
                if constexpr (indexed) cut.node = {key_[low], key_[high]};
                return cut;
            };
            v[i] = add_named(names[i], make);
        }
        if (l == 0) layer.sink.add_element(s.element, s.shape, s.level);
        count_simplices(simplices_of(loop));
        if (n <= 3 || loop.any_diagonal) {
            put_loop(v, n, mirrored);
        } else {
            for (std::size_t i = 0; i < loop.triangle_count; ++i) {
                const auto& corner = loop.triangle[i];
                put_triangle(v, {corner[0], corner[1], corner[2]}, mirrored);
            }
        }
        if constexpr (indexed) put_boundary(v, n, loop.face, walk_->boundary(s));
    }
}

/// A vertex on a closed edge.
NESTGRID_VISITOR::add_closed(const State& s, std::uint8_t edge, const VertexName& name) -> Vertex {
    return add_named(name, [&] { return make_cut(s, *layer_, edge); });
}

/// Three vertices of a loop; a segment of its first two in two dimensions.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Vertices>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_triangle(
    const Vertices& v, const std::array<std::size_t, 3>& corner, bool mirrored) {
    // Nobody can predict which: no branch.
    const std::size_t swap = (corner[0] ^ corner[1]) & (std::size_t{0} - (mirrored ? 1U : 0U));
    const Vertex a(v[corner[0] ^ swap]);
    const Vertex b(v[corner[1] ^ swap]);
    if constexpr (dimension == 2) {
        put_simplex({a, b}, {});
    } else {
        put_simplex({a, b, Vertex(v[corner[2]])}, {});
    }
}

/// A loop that is a segment, a triangle, or two with the shorter diagonal.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Vertices>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_loop(
    const Vertices& v, std::size_t count, bool mirrored) {
    const auto position = [&](std::size_t i) -> decltype(auto) {
        if constexpr (indexed) {
            return layer_->sink.position(v[i]);
        } else {
            return (v[i]);
        }
    };
    if (count < 4) return put_triangle(v, {0, 1, 2}, mirrored);
    const std::size_t first = shorter(position(0), position(2), position(1), position(3)) ? 0 : 1;
    put_triangle(v, {first, first + 1, first + 2}, mirrored);
    put_triangle(v, {first + 2, (first + 3) % 4, first}, mirrored);
}

/// The sides of a loop that lie on the boundary of the domain.
/// \param face behind each vertex
/// \param boundary the element's faces there, one bit each
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Vertices, class Faces>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::put_boundary(
    const Vertices& v, std::size_t count, const Faces& face, unsigned boundary) {
    for (std::size_t i = 0; boundary != 0 && i < count; ++i) {
        if ((boundary >> face[i] & 1U) == 0) continue;
        if constexpr (dimension == 2) {
            layer_->sink.add_boundary({v[i]});
        } else {
            layer_->sink.add_boundary({v[i], v[(i + 1) % count]});
        }
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
