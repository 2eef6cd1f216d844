// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/cap_contour.hpp>

#include <algorithm>
#include <bit>
#include <utility>

namespace nestgrid::engine {

/// Calls function(face, polygon) for each polygon inside the level on each of the faces.
template <int dimension, class Real>
template <class Function>
void CapContour<dimension, Real>::for_each_polygon(unsigned inside, unsigned faces,
                                                   Function&& function) const {
    const ElementView<Real>& view = cuts_->view();
    const Topology& t = view.topology();
    for (std::size_t f = 0; f < t.faces; ++f) {
        if ((faces >> f & 1U) == 0) continue;
        const FaceTopology& face = t.face[f];
        const unsigned signs = signs_of(face, inside);
        const FaceContour& contour = cuts_->contour(face, signs);
        for (unsigned left = signs; left != 0;) {
            function(face, polygon_from(view.shape, face, signs, contour, left));
        }
    }
}

/// Makes the polygon around the first corner in the set `left`, and removes its corners from the
/// set.
template <int dimension, class Real>
auto CapContour<dimension, Real>::polygon_from(Shape shape, const FaceTopology& face,
                                               unsigned signs, const FaceContour& contour,
                                               unsigned& left) -> Polygon {
    Polygon polygon;
    const auto add = [&](std::size_t from, bool cut, std::uint8_t edge) {
        polygon.corner[polygon.count] = {static_cast<std::uint8_t>(from), cut};
        polygon.edge[polygon.count++] = edge;
    };
    auto i = static_cast<std::size_t>(std::countr_zero(left));
    while ((left >> i & 1U) != 0) {
        left &= ~(1U << i);
        const std::size_t next = (i + 1) % face.corners;
        add(i, false, edge_at(shape, face, i));
        if ((signs >> next & 1U) != 0) {
            i = next;
            continue;
        }
        add(i, true, no_edge);
        std::size_t rises = 0;
        for (std::size_t k = 0; k < contour.count; ++k) {
            if (contour.segment[k].falls == i) rises = contour.segment[k].rises;
        }
        i = (rises + 1) % face.corners;
        add(rises, true, edge_at(shape, face, rises));
    }
    return polygon;
}

template <int dimension, class Real>
NodeKey CapContour<dimension, Real>::edge_key(std::uint8_t edge) const {
    FaceKey key;
    if (const auto* maximal = cuts_->view().closed.edge(edge)) {
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}})
            key.add_corner(maximal->key(end));
    } else {
        const auto& ends = cuts_->view().topology().edge[edge];
        for (const std::uint8_t end : ends) key.add_corner(cuts_->keys()[end]);
    }
    return key.key();
}

template <int dimension, class Real>
void CapContour<dimension, Real>::record(unsigned inside, unsigned faces,
                                         TransitionContours& record) const {
    if (dimension == 2) return;
    for_each_polygon(inside, faces, [&](const FaceTopology& face, const Polygon& polygon) {
        for (std::size_t i = 0; i < polygon.count; ++i) record_side(face, polygon, i, record);
    });
}

/// Records the nodes at the ends of a side of a polygon that lies on a closed edge.
template <int dimension, class Real>
void CapContour<dimension, Real>::record_side(const FaceTopology& face, const Polygon& polygon,
                                              std::size_t side, TransitionContours& record) const {
    const std::uint8_t edge = polygon.edge[side];
    if (edge == no_edge || cuts_->view().closed.edge(edge) == nullptr) return;
    for (const std::size_t end : {side, (side + 1) % polygon.count}) {
        if (polygon.corner[end].cut) continue;
        const std::uint8_t corner = face.corner[polygon.corner[end].from];
        const NodeKey key = cuts_->keys()[corner];
        const Number vertex = record.by_names()
                                  ? record.vertex({key, key}, [&] { return cuts_->node(corner); })
                                  : contour_->of_surface(contour_->node_vertex(corner));
        const auto* const around = cuts_->view().closed.edge(edge);
        record.record_on_edge(edge_key(edge), {around->key(0), around->key(1)}, vertex);
    }
}

/// The nodes that polygons around an edge recorded between the ends of a side along it. At a cut
/// the edge leaves the level, so that no node beyond the cut was recorded.
template <int dimension, class Real>
auto CapContour<dimension, Real>::chain(const FaceTopology& face, const Polygon& polygon,
                                        std::size_t side, const Recorded& recorded)
    -> std::vector<Number> {
    const std::uint8_t edge = polygon.edge[side];
    const TransitionContours* const record = recorded.by_caps;
    if (edge == no_edge || record == nullptr || record->empty()) return {};
    const Number* const on_edge = record->find_face(recorded.edge_key[edge]);
    if (on_edge == nullptr) return {};
    const Corner& from = polygon.corner[side];
    const Corner& to = polygon.corner[(side + 1) % polygon.count];
    const auto& x = cuts_->positions();
    const Point begin = x[face.corner[from.from]];
    const Point along = x[face.corner[(from.from + 1U) % face.corners]] - begin;
    std::vector<std::pair<double, Number>> between;
    record->for_each_from(*on_edge, [&](Number v) {
        const double at = dot(contour_->recorded_position(*record, v) - begin, along);
        if ((from.cut || at > 0) && (to.cut || at < dot(along, along))) between.emplace_back(at, v);
    });
    std::sort(between.begin(), between.end());
    between.erase(std::unique(between.begin(), between.end()), between.end());
    std::vector<Number> chain;
    for (const auto& [at, v] : between) {
        chain.push_back(contour_->adopted(*record, v, face));
    }
    return chain;
}

template <int dimension, class Real>
void CapContour<dimension, Real>::draw(unsigned inside, unsigned faces, const Recorded& recorded) {
    if (dimension == 2) return draw_segments(inside, faces);
    for_each_polygon(inside, faces, [&](const FaceTopology& face, const Polygon& polygon) {
        draw_polygon(face, polygon, recorded);
    });
}

/// Draws the inside parts of the sides on the boundary. They run counterclockwise around the
/// element, with the region inside the level on their left, as the contour does.
template <int dimension, class Real>
void CapContour<dimension, Real>::draw_segments(unsigned inside, unsigned faces) {
    const ElementView<Real>& view = cuts_->view();
    const Topology& t = view.topology();
    for (std::size_t f = 0; f < t.faces; ++f) {
        const std::uint8_t a = t.face[f].corner[0];
        const std::uint8_t b = t.face[f].corner[1];
        const bool first = (inside >> a & 1U) != 0;
        const bool second = (inside >> b & 1U) != 0;
        if ((faces >> f & 1U) == 0 || (!first && !second)) continue;
        const std::uint8_t edge = edge_between(view.shape, a, b);
        typename ElementContour<dimension, Real>::Locals ends{};
        ends[0] = first ? contour_->node_vertex(a) : contour_->vertex(edge);
        ends[1] = second ? contour_->node_vertex(b) : contour_->vertex(edge);
        contour_->simplex(ends);
    }
}

template <int dimension, class Real>
void CapContour<dimension, Real>::draw_polygon(const FaceTopology& face, const Polygon& polygon,
                                               const Recorded& recorded) {
    const std::size_t n = polygon.count;
    std::array<Number, 8> v{};
    std::array<std::vector<Number>, 8> chains;
    for (std::size_t i = 0; i < n; ++i) {
        const Corner& c = polygon.corner[i];
        v[i] = c.cut ? contour_->vertex(edge_at(cuts_->view().shape, face, c.from))
                     : contour_->node_vertex(face.corner[c.from]);
        chains[i] = chain(face, polygon, i, recorded);
    }
    ContourFilling<ElementContour<dimension, Real>> filling(*contour_);
    for (std::size_t i = 2; i < n; ++i) {
        const std::span<const Number> none_there;
        filling.add(v[0], v[i - 1], v[i], i == 2 ? chains[0] : none_there, chains[i - 1],
                    i + 1 == n ? chains[i] : none_there);
    }
}

template class CapContour<2, float>;
template class CapContour<2, double>;
template class CapContour<3, float>;
template class CapContour<3, double>;

}  // namespace nestgrid::engine
