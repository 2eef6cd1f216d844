// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How an ElementContour draws plain contours, to be compiled into the walk that draws.
#pragma once

#include <level_sets/element_contour.hpp>

namespace nestgrid::engine {

template <int dimension, class Real>
NESTGRID_INLINE std::size_t ElementContour<dimension, Real>::simplices_of(const Contour& plain) {
    std::size_t count = 0;
    for (std::size_t l = 0; l < plain.loop_count; ++l) {
        const std::size_t cuts = plain.loop[l].count;
        count += cuts <= 3 ? 1 : cuts - 2;
    }
    return count;
}

template <int dimension, class Real>
NESTGRID_INLINE void ElementContour<dimension, Real>::draw_plainly(DrawnSurface<dimension>& surface,
                                                                   const Contour& contour,
                                                                   unsigned inside,
                                                                   Vertices* by_edge) {
    const ElementView<Real>& view = cuts_->view();
    surface_ = &surface;
    surface.builder().add_element(view.element(), view.shape, view.level);
    tally_->add(simplices_of(contour));
    const bool names = surface.names_vertices();
    const bool batches = surface.builder().takes_batches() && cuts_->attribute_count() == 0;
    const unsigned boundary = names ? cuts_->walk().boundary(view) : 0;
    for (std::size_t l = 0; l < contour.loop_count; ++l) {
        const ContourLoop& loop = contour.loop[l];
        if (batches) {
            hand_over_loop(loop, inside, view.orientation < 0);
            continue;
        }
        const Vertices v = names ? find_vertices(loop, inside) : make_vertices(loop, inside);
        put_loop(loop, v, view.orientation < 0);
        if (boundary != 0) put_boundary(loop, v, boundary);
        if (by_edge == nullptr) continue;
        for (std::size_t i = 0; i < loop.count; ++i) (*by_edge)[loop.edge[i]] = v[i];
    }
}

/// Finds the vertices of a loop. Fetches the slots of all names first, so that no look-up waits for
/// the slot of another name.
template <int dimension, class Real>
auto ElementContour<dimension, Real>::find_vertices(const ContourLoop& loop, unsigned inside)
    -> Vertices {
    std::array<VertexNumbers::Name, max_edges> names;
    for (std::size_t i = 0; i < loop.count; ++i) {
        names[i] = surface_->name(cuts_->name(loop.edge[i]));
        surface_->prefetch(names[i]);
    }
    const bool any = cuts_->attribute_count() > 0;
    Vertices v;
    for (std::size_t i = 0; i < loop.count; ++i) {
        v[i] = surface_->vertex(names[i], [&] {
            const bool whole = any || cuts_->view().closed.edge(loop.edge[i]) != nullptr;
            return whole ? cuts_->cut(loop.edge[i]) : cuts_->plain_cut(loop.edge[i], inside);
        });
    }
    return v;
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::plain_vertices(DrawnSurface<dimension>& surface,
                                                     const Contour& contour, unsigned inside)
    -> Vertices {
    surface_ = &surface;
    Vertices on_edge;
    for (std::size_t l = 0; l < contour.loop_count; ++l) {
        const ContourLoop& loop = contour.loop[l];
        const Vertices v = find_vertices(loop, inside);
        for (std::size_t i = 0; i < loop.count; ++i) on_edge[loop.edge[i]] = v[i];
    }
    return on_edge;
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::draw_between(DrawnSurface<dimension>& surface,
                                                   const Contour& contour, const Vertices& v,
                                                   bool mirrored, unsigned boundary) {
    surface_ = &surface;
    tally_->add(simplices_of(contour));
    for (std::size_t l = 0; l < contour.loop_count; ++l) {
        const ContourLoop& loop = contour.loop[l];
        Vertices in_loop;
        for (std::size_t i = 0; i < loop.count; ++i) in_loop[i] = v[loop.edge[i]];
        put_loop(loop, in_loop, mirrored);
        if (boundary != 0) put_boundary(loop, in_loop, boundary);
    }
}

template <int dimension, class Real>
NESTGRID_INLINE auto ElementContour<dimension, Real>::make_vertices(const ContourLoop& loop,
                                                                    unsigned inside) -> Vertices {
    Vertices v;
    if (cuts_->attribute_count() > 0) {
        for (std::size_t i = 0; i < loop.count; ++i) {
            v[i] = surface_->add(cuts_->cut(loop.edge[i]));
        }
        return v;
    }
    std::array<Point, max_edges> x;
    cuts_->positions_of(std::span(loop.edge).first(loop.count), inside, x.data());
    Number next = surface_->add_unnamed(std::span(x).first(loop.count), {});
    for (std::size_t i = 0; i < loop.count; ++i) v[i] = next++;
    return v;
}

/// Divides a loop into simplices: a segment, the triangles of the table, or two with the shorter
/// diagonal. Both diagonals lie inside the element, so that its neighbours do not depend on the
/// choice.
/// \param x x(i) is the position of place i in the loop
/// \param put put(simplex) takes places in the loop
template <int dimension, class Real>
template <class Position, class Put>
NESTGRID_INLINE void ElementContour<dimension, Real>::divide_loop(const ContourLoop& loop,
                                                                  bool mirrored, const Position& x,
                                                                  const Put& put) {
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) NESTGRID_INLINE_LAMBDA {
        // Branch-free: mirroring is unpredictable.
        const std::size_t swap = (a ^ b) & (std::size_t{0} - (mirrored ? 1U : 0U));
        put(a ^ swap, b ^ swap, c);
    };
    if (loop.count <= 3) return triangle(0, 1, 2);
    if (loop.any_diagonal) {
        const std::size_t first = shorter(x(0), x(2), x(1), x(3)) ? 0 : 1;
        triangle(first, first + 1, first + 2);
        triangle(first + 2, (first + 3) % 4, first);
        return;
    }
    for (std::size_t i = 0; i < loop.triangle_count; ++i) {
        const auto& corner = loop.triangle[i];
        triangle(corner[0], corner[1], corner[2]);
    }
}

/// Adds the simplices of a loop.
template <int dimension, class Real>
NESTGRID_INLINE void ElementContour<dimension, Real>::put_loop(const ContourLoop& loop,
                                                               const Vertices& v, bool mirrored) {
    divide_loop(
        loop, mirrored, [&](std::size_t i) { return surface_->position(v[i]); },
        [&](std::size_t a, std::size_t b, std::size_t c) NESTGRID_INLINE_LAMBDA {
            Locals simplex;
            simplex[0] = v[a];
            simplex[1] = v[b];
            if constexpr (dimension == 3) simplex[2] = v[c];
            surface_->add_simplex(simplex, {});
        });
}

/// Hands the simplices of a loop to a sink that takes batches.
template <int dimension, class Real>
NESTGRID_INLINE void ElementContour<dimension, Real>::hand_over_loop(const ContourLoop& loop,
                                                                     unsigned inside,
                                                                     bool mirrored) {
    std::array<Point, max_edges> x;
    cuts_->positions_of(std::span(loop.edge).first(loop.count), inside, x.data());
    std::array<std::array<std::uint16_t, 3>, max_edges> simplices;
    std::size_t count = 0;
    divide_loop(
        loop, mirrored, [&](std::size_t i) { return x[i]; },
        [&](std::size_t a, std::size_t b, std::size_t c) NESTGRID_INLINE_LAMBDA {
            simplices[count++] = {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b),
                                  static_cast<std::uint16_t>(c)};
        });
    surface_->builder().take_batch(
        {x.data()->data(), Point{}.size(), std::span(simplices).first(count)});
}

/// Adds the sides of a loop that lie on the boundary of the domain.
/// \param boundary the element's faces on it, one bit each
template <int dimension, class Real>
void ElementContour<dimension, Real>::put_boundary(const ContourLoop& loop, const Vertices& v,
                                                   unsigned boundary) {
    for (std::size_t i = 0; i < loop.count; ++i) {
        if ((boundary >> loop.face[i] & 1U) == 0) continue;
        typename Surface<dimension>::Ridge ridge;
        for (std::size_t k = 0; k < ridge.size(); ++k) ridge[k] = v[(i + k) % loop.count];
        surface_->builder().add_boundary(ridge);
    }
}

}  // namespace nestgrid::engine
