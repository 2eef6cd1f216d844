// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drawing elements of which nothing is special; included by isosurface_steps.hpp.
//
// That is: no edge or face around them is closed, no signs on a face alternate, no loop is filled
// around its middle, and nothing but vertices and triangles is asked for. Most elements are like
// that, and what is drawn of them, and in which order, is what draw() draws, to the last bit.
#pragma once

#include <nestgrid/algorithms/isosurface.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

/// The contour of a sign pattern, where it is plain; else null.
template <class Grid, class Field, class S, class Indicator, class Sink>
NESTGRID_INLINE const Contour* IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::plain_contour(
    Shape shape, unsigned bits) {
    const ContourTable*& table = table_[static_cast<std::size_t>(shape)];
    if (table == nullptr) table = &ContourTable::of(shape);
    return table->plain(bits);
}

/// Draws a plain contour; positions (and keys) of the corners are loaded.
template <class Grid, class Field, class S, class Indicator, class Sink>
template <class AnyState, class Boundary>
NESTGRID_INLINE void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::draw_plainly(
    const AnyState& s, Shape shape, Layer& layer, const Contour* contour, unsigned bits,
    const Boundary& boundary_faces) {
    constexpr bool simplices = State::capacity == static_cast<std::size_t>(dimension) + 1;
    layer_ = &layer;
    const Topology& t = topology(shape);
    [[maybe_unused]] unsigned boundary = 0;
    if constexpr (indexed) boundary = boundary_faces();
    const std::size_t loops = simplices ? 1 : contour->loop_count;
    for (std::size_t l = 0; l < loops; ++l) {
        const ContourLoop& loop = contour->loop[l];
        const std::size_t n = loop.count;
        std::array<Vertex, simplices ? 4 : max_edges> v;
        for (std::size_t i = 0; i < n; ++i) {
            const auto [a, b] = t.edge[loop.edge[i]];
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
            v[i] = add({key_[low], key_[high]}, make);
        }
        if (l == 0) layer.sink.add_element(s.element, shape, s.level);
        const auto put = [&](std::size_t a, std::size_t b, [[maybe_unused]] std::size_t c) {
            if (s.orientation < 0) std::swap(a, b);
            if constexpr (dimension == 2) {
                put_simplex({v[a], v[b]}, {});
            } else {
                put_simplex({v[a], v[b], v[c]}, {});
            }
        };
        if (n <= 3) {
            put(0, 1, 2);
        } else if (loop.any_diagonal) {
            const auto position = [&](std::size_t i) {
                if constexpr (indexed) {
                    return layer.sink.position(v[i]);
                } else {
                    return v[i];
                }
            };
            const std::size_t a =
                shorter(position(0), position(2), position(1), position(3)) ? 0 : 1;
            put(a, a + 1, a + 2);
            put(a + 2, (a + 3) % 4, a);
        } else {
            for (std::size_t i = 0; i < loop.triangle_count; ++i) {
                put(loop.triangle[i][0], loop.triangle[i][1], loop.triangle[i][2]);
            }
        }
        if constexpr (indexed && dimension == 2) {
            for (std::size_t i = 0; boundary != 0 && i < n; ++i) {
                if ((boundary >> loop.face[i] & 1U) != 0) layer.sink.add_boundary({v[i]});
            }
        } else if constexpr (indexed) {
            for (std::size_t i = 0; boundary != 0 && i < n; ++i) {
                if ((boundary >> loop.face[i] & 1U) == 0) continue;
                layer.sink.add_boundary({v[i], v[(i + 1) % n]});
            }
        }
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
