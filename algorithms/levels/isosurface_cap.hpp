// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that cap the surface: they draw the part of each boundary face where
// U >= C.
//
// Two boundary faces meet in an edge, and one may be finer than the other. So the finer one records
// its sides along closed edges, under the key of the maximal edge and the direction it runs in, and
// the other one adopts the vertices between: what is done for faces, one dimension lower.
#pragma once

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

/// Calls function(face, polygon) for each polygon of U >= C on each boundary face.
template <int dimension, class Real, bool indexed>
template <class Function>
void IsosurfaceVisitor<dimension, Real, indexed>::for_each_cap_polygon(const View& s,
                                                                       unsigned pattern,
                                                                       Function&& function) const {
    const Topology& t = s.topology();
    const unsigned boundary = walk_->boundary(s);
    for (std::size_t f = 0; f < t.faces; ++f) {
        if ((boundary >> f & 1U) == 0) continue;
        const FaceTopology& face = t.face[f];
        const std::size_t n = face.corners;
        unsigned signs = 0;
        for (std::size_t i = 0; i < n; ++i) signs |= (pattern >> face.corner[i] & 1U) << i;
        const bool alternating = n == 4 && (signs == 5 || signs == 10);
        const FaceContour contour = face_contour(n, signs, alternating && joined(s, face));
        unsigned left = signs;
        while (left != 0) {
            CapPolygon polygon;
            auto i = static_cast<std::size_t>(std::countr_zero(left));
            const auto add = [&](std::size_t from, bool cut, std::uint8_t edge) {
                polygon.point[polygon.count] = {static_cast<std::uint8_t>(from), cut};
                polygon.edge[polygon.count++] = edge;
            };
            while ((left >> i & 1U) != 0) {
                left &= ~(1U << i);
                const std::size_t next = (i + 1) % n;
                add(i, false, edge_between(s.shape, face.corner[i], face.corner[next]));
                if ((signs >> next & 1U) != 0) {
                    i = next;
                    continue;
                }
                add(i, true, no_edge);
                std::size_t rises = 0;
                for (std::size_t k = 0; k < contour.count; ++k) {
                    if (contour.segment[k].falls == i) rises = contour.segment[k].rises;
                }
                i = (rises + 1) % n;
                add(rises, true, edge_between(s.shape, face.corner[rises], face.corner[i]));
            }
            function(face, polygon);
        }
    }
}

/// Key of the sides along the maximal edge of an edge that run from corner `from` of the face to
/// the next one, or the other way.
template <int dimension, class Real, bool indexed>
NodeKey IsosurfaceVisitor<dimension, Real, indexed>::side_key(const View& s, std::uint8_t edge,
                                                              const FaceTopology& face,
                                                              std::uint8_t from,
                                                              bool forward) const {
    const std::uint8_t a = face.corner[from];
    const std::uint8_t b = face.corner[(from + 1U) % face.corners];
    bool upwards = key_[a] < key_[b];
    std::array<NodeKey, 2> ends{key_[a], key_[b]};
    if (const auto* m = s.closed.edge(edge)) {
        ends = {m->key(0), m->key(1)};
        const auto [begin, end] = walk_->positions(*m);
        const bool along = dot(x_[b] - x_[a], end - begin) > 0;
        upwards = along == (ends[0] < ends[1]);
    }
    const bool up = upwards == (forward == (s.orientation > 0));
    FaceKey key;
    for (const NodeKey end : ends) key.add_corner(end);
    return key.key() + (up ? 1 : 0);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::record_cap(const View& s, Layer& layer,
                                                             unsigned pattern) {
    if constexpr (dimension == 3) {
        for_each_cap_polygon(s, pattern, [&](const FaceTopology& face, const CapPolygon& polygon) {
            for (std::size_t i = 0; i < polygon.count; ++i) {
                const std::uint8_t edge = polygon.edge[i];
                if (edge == no_edge || s.closed.edge(edge) == nullptr) continue;
                const auto end = [&](const CapPoint& p) {
                    const std::uint8_t corner = face.corner[p.from];
                    if (!p.cut) {
                        return layer.transitions.vertex({key_[corner], key_[corner]},
                                                        [&] { return make_node(s, corner); });
                    }
                    return layer.transitions.vertex(name(s, edge),
                                                    [&] { return make_cut(s, layer, edge); });
                };
                const Number from = end(polygon.point[i]);
                const Number to = end(polygon.point[(i + 1) % polygon.count]);
                const NodeKey key = side_key(s, edge, face, polygon.point[i].from, true);
                if (s.orientation > 0) {
                    layer.transitions.record(key, from, to);
                } else {
                    layer.transitions.record(key, to, from);
                }
            }
        });
    }
}

/// The vertices on a side of a polygon that a finer polygon beyond it has there.
template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::cap_chain(const View& s, Layer& layer,
                                                            const FaceTopology& face,
                                                            const CapPolygon& polygon,
                                                            std::size_t side)
    -> std::vector<Number> {
    std::vector<Number> between;
    const std::uint8_t edge = polygon.edge[side];
    if (edge == no_edge || recording_ || layer.drawn_below->empty()) return between;
    const Number* sides =
        layer.drawn_below->find_face(side_key(s, edge, face, polygon.point[side].from, false));
    if (sides == nullptr) return between;
    const auto end = [&](const CapPoint& p) {
        const NodeKey key = key_[face.corner[p.from]];
        return layer.drawn_below->find(p.cut ? name(s, edge) : KeyPair(key, key));
    };
    const Number* from = end(polygon.point[side]);
    const Number* to = end(polygon.point[(side + 1) % polygon.count]);
    if (from == nullptr || to == nullptr) return between;
    const bool mirrored = s.orientation < 0;
    if (mirrored) std::swap(from, to);
    const bool found = layer.drawn_below->follow(
        *sides, *to, [&](Number v) { return v == *from; }, [&](Number v) { between.push_back(v); });
    if (!found) return {};
    if (!mirrored) std::reverse(between.begin(), between.end());
    for (Number& v : between) v = recorded(v, face);
    return between;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::draw_cap(const View& s, Layer& layer,
                                                           unsigned pattern) {
    if constexpr (dimension == 2) {
        const Topology& t = s.topology();
        const unsigned boundary = walk_->boundary(s);
        for (std::size_t f = 0; f < t.faces; ++f) {
            const auto& [a, b, unused0, unused1] = t.face[f].corner;
            const bool first = (pattern >> a & 1U) != 0;
            const bool second = (pattern >> b & 1U) != 0;
            if ((boundary >> f & 1U) == 0 || (!first && !second)) continue;
            // Counterclockwise around the element the region is on the left, as on the contour.
            simplex({first ? node_vertex(a) : vertex(edge_between(s.shape, a, b)),
                     second ? node_vertex(b) : vertex(edge_between(s.shape, a, b))});
        }
    } else {
        for_each_cap_polygon(s, pattern, [&](const FaceTopology& face, const CapPolygon& polygon) {
            std::array<Number, 8> v{};
            std::array<std::vector<Number>, 8> chains;
            const std::size_t n = polygon.count;
            for (std::size_t i = 0; i < n; ++i) {
                const CapPoint& p = polygon.point[i];
                v[i] = p.cut ? vertex(edge_between(s.shape, face.corner[p.from],
                                                   face.corner[(p.from + 1U) % face.corners]))
                             : node_vertex(face.corner[p.from]);
                chains[i] = cap_chain(s, layer, face, polygon, i);
            }
            ContourFilling<IsosurfaceVisitor> filling(*this);
            for (std::size_t i = 2; i < n; ++i) {
                const std::span<const Number> none_there;
                filling.add(v[0], v[i - 1], v[i], i == 2 ? chains[0] : none_there, chains[i - 1],
                            i + 1 == n ? chains[i] : none_there);
            }
        });
    }
}

}  // namespace nestgrid::engine
