// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that draw plain elements.
//
// An element is plain where no finer side drew on its faces, no signs on a face alternate, no loop
// is filled around its middle, and nothing but vertices and triangles is asked for. Most elements
// are plain. They are drawn as draw() would draw them, in the same order and to the last bit.
#pragma once

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

/// The table of a shape, which is made when it is met.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE const ContourTable& IsosurfaceVisitor<dimension, Real, indexed>::contours_of(
    Shape shape) {
    const ContourTable*& table = table_[static_cast<std::size_t>(shape)];
    if (table == nullptr) table = &ContourTable::of(shape);
    return *table;
}

/// The contour of a sign pattern, where it is plain; else null.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE const Contour* IsosurfaceVisitor<dimension, Real, indexed>::plain_contour(
    Shape shape, unsigned bits) {
    return contours_of(shape).plain(bits);
}

/// How many triangles (segments) a loop without a vertex in its middle is drawn as.
template <int dimension, class Real, bool indexed>
std::size_t IsosurfaceVisitor<dimension, Real, indexed>::simplices_of(const ContourLoop& loop) {
    return loop.count <= 3 ? 1 : std::size_t{loop.count} - 2;
}

/// The same of a plain contour.
template <int dimension, class Real, bool indexed>
std::size_t IsosurfaceVisitor<dimension, Real, indexed>::simplices_of(const Contour& contour) {
    std::size_t count = 0;
    for (std::size_t l = 0; l < contour.loop_count; ++l) count += simplices_of(contour.loop[l]);
    return count;
}

/// Draws a plain contour; positions (and keys) of the corners are loaded.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE void IsosurfaceVisitor<dimension, Real, indexed>::draw_plainly(
    const View& s, Layer& layer, const Contour* contour, unsigned bits) {
    layer_ = &layer;
    const Topology& t = s.topology();
    const bool mirrored = s.orientation < 0;
    const std::size_t loops = contour->loop_count;
    for (std::size_t l = 0; l < loops; ++l) {
        const ContourLoop& loop = contour->loop[l];
        const std::size_t n = loop.count;
        std::array<Vertex, max_edges> v;
        std::array<VertexName, max_edges> names;
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
                cut.fraction =
                    cut_fraction(layer.isovalue, static_cast<double>(s.value[low * components_]),
                                 static_cast<double>(s.value[high * components_]));
                cut.x = x_[low] + cut.fraction * (x_[high] - x_[low]);
                cut.node = {key_[low], key_[high]};
                return cut;
            };
            v[i] = add_named(names[i], make);
        }
        if (l == 0) layer.sink.add_element(s.element(), s.shape, s.level);
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
template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::add_closed(const View& s, std::uint8_t edge,
                                                             const VertexName& name) -> Vertex {
    return add_named(name, [&] { return make_cut(s, *layer_, edge); });
}

/// Three vertices of a loop; a segment of its first two in two dimensions.
template <int dimension, class Real, bool indexed>
template <class Vertices>
NESTGRID_INLINE void IsosurfaceVisitor<dimension, Real, indexed>::put_triangle(
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
template <int dimension, class Real, bool indexed>
template <class Vertices>
NESTGRID_INLINE void IsosurfaceVisitor<dimension, Real, indexed>::put_loop(const Vertices& v,
                                                                           std::size_t count,
                                                                           bool mirrored) {
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
template <int dimension, class Real, bool indexed>
template <class Vertices, class Faces>
NESTGRID_INLINE void IsosurfaceVisitor<dimension, Real, indexed>::put_boundary(const Vertices& v,
                                                                               std::size_t count,
                                                                               const Faces& face,
                                                                               unsigned boundary) {
    for (std::size_t i = 0; boundary != 0 && i < count; ++i) {
        if ((boundary >> face[i] & 1U) == 0) continue;
        if constexpr (dimension == 2) {
            layer_->sink.add_boundary({v[i]});
        } else {
            layer_->sink.add_boundary({v[i], v[(i + 1) % count]});
        }
    }
}

}  // namespace nestgrid::engine
