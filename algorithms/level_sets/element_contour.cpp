// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/element_contour_steps.hpp>

#include <algorithm>

#include <nestgrid/detail/shape_functions.hpp>

namespace nestgrid::engine {

template <int dimension, class Real>
void ElementContour<dimension, Real>::begin(DrawnSurface<dimension>& surface, bool mirrored) {
    surface_ = &surface;
    begun_ = false;
    mirrored_ = mirrored;
    chained_ = 0;
    local_.clear();
    reference_.clear();
    on_edge_.fill(none);
    on_corner_.fill(none);
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::set_chain(std::uint8_t edge, std::vector<Number>& chain) {
    chained_ |= static_cast<std::uint16_t>(1U << edge);
    chain_[edge].swap(chain);
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::draw(unsigned inside, unsigned joins, unsigned boundary) {
    const ElementView<Real>& view = cuts_->view();
    const Contour& contour = table(view.shape).at(inside, joins);
    if constexpr (dimension == 2) {
        for (std::size_t l = 0; l < contour.loop_count; ++l) {
            const ContourLoop& segment = contour.loop[l];
            simplex({vertex(segment.edge[0]), vertex(segment.edge[1])});
        }
    } else {
        ContourFilling<ElementContour> filling(*this);
        std::optional<Tunnel> tunnel;
        if (view.shape == Shape::hexahedron && contour.loop_count > 1) {
            tunnel = find_tunnel(contour, cuts_->u());
        }
        tunnel ? filling.fill(contour, *tunnel) : filling.fill(contour);
    }
    for (std::size_t l = 0; boundary != 0 && l < contour.loop_count; ++l) {
        Vertices v;
        for (std::size_t i = 0; i < contour.loop[l].count; ++i) {
            v[i] = local_[vertex(contour.loop[l].edge[i])];
        }
        put_boundary(contour.loop[l], v, boundary);
    }
}

template <int dimension, class Real>
unsigned ElementContour<dimension, Real>::own_joins(unsigned alternating) const {
    constexpr FaceTopology element{Shape::quadrilateral, 4, {0, 1, 3, 2}};  // in two dimensions
    unsigned joins = 0;
    for (unsigned left = alternating; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const bool joined =
            cuts_->joined(dimension == 2 ? element : cuts_->view().topology().face[f]);
        joins |= unsigned{joined} << f;
    }
    return joins;
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::simplex(const Locals& corners) {
    if (!begun_) {
        const ElementView<Real>& view = cuts_->view();
        surface_->builder().add_element(view.element(), view.shape, view.level);
    }
    begun_ = true;
    Locals v;
    std::array<Point, static_cast<std::size_t>(dimension)> reference;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::size_t from = i < 2 && mirrored_ ? 1 - i : i;
        v[i] = local_[corners[from]];
        if (options_->reference) reference[i] = reference_[corners[from]];
    }
    tally_->add(1);
    surface_->add_simplex(
        v, options_->reference ? std::span<const Point>(reference) : std::span<const Point>());
}

/// Adds a vertex in the middle of the gap, so that no edge inside the filling is an edge of an
/// element.
template <int dimension, class Real>
void ElementContour<dimension, Real>::fill_gap(DrawnSurface<dimension>& surface,
                                               const TransitionContours& record,
                                               const TransitionContours::Gap& gap) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    constexpr Point nowhere{unknown, unknown, unknown};
    begin(surface, false);
    begun_ = true;
    surface_->builder().add_element(record.element(gap.owner), gap.owner.shape, gap.owner.level);
    Point x{0, 0, 0};
    std::vector<double> attributes(cuts_->attribute_count(), 0.0);
    const double weight = 1.0 / static_cast<double>(gap.loop.size());
    for (const Number recorded : gap.loop) {
        const Number v = number_of(of_record(record, recorded), nowhere);
        x = x + weight * recorded_position(record, recorded);
        if (attributes.empty()) continue;
        const std::span<const double> data = record.by_names()
                                                 ? record.cut(recorded).attributes
                                                 : surface_->builder().attributes(local_[v]);
        for (std::size_t i = 0; i < attributes.size(); ++i) attributes[i] += weight * data[i];
    }
    const auto n = static_cast<Number>(gap.loop.size());
    if (n == 3) return triangle(0, 1, 2);
    number_of(surface_->add_unnamed(std::span(&x, 1), attributes), nowhere);
    for (Number i = 0; i < n; ++i) triangle(i, (i + 1) % n, n);
}

/// The vertex of the surface that is a recorded one.
template <int dimension, class Real>
auto ElementContour<dimension, Real>::of_record(const TransitionContours& record, Number recorded)
    -> Number {
    if (!record.by_names()) return recorded;
    const SurfaceCut cut = record.cut(recorded);
    return surface_->vertex_between({cut.node[0], cut.node[1]}, [&] { return cut; });
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::number_of(Number vertex, const Point& reference) -> Number {
    local_.push_back(vertex);
    if (wants_reference()) reference_.push_back(reference);
    return static_cast<Number>(local_.size() - 1);
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::vertex(std::uint8_t edge) -> Number {
    if (on_edge_[edge] != none) return on_edge_[edge];
    const Point reference = wants_reference() ? reference_on_edge(edge) : Point{};
    const Number v = surface_->vertex_between(cuts_->name(edge), [&] { return cuts_->cut(edge); });
    if (options_->at_nodes) put_at_node(v, cuts_->corner_at_level(edge));
    return on_edge_[edge] = number_of(v, reference);
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::take_vertex(std::uint8_t edge, Number of_surface,
                                                  bool corners) {
    const bool wanted = wants_reference() && corners;
    on_edge_[edge] = number_of(of_surface, wanted ? reference_on_edge(edge) : Point{});
}

template <int dimension, class Real>
void ElementContour<dimension, Real>::take_cut(std::uint8_t edge, const SurfaceCut& cut,
                                               bool corners) {
    const KeyPair name(cut.node[0], cut.node[1]);
    const Number v = surface_->vertex_between(name, [&] { return cut; });
    if (options_->at_nodes) put_at_node(v, cuts_->corner_at_level(edge));
    take_vertex(edge, v, corners);
}

/// The reference coordinates of the cut of an edge.
template <int dimension, class Real>
Point ElementContour<dimension, Real>::reference_on_edge(std::uint8_t edge) const {
    const Topology& t = cuts_->view().topology();
    const auto& [a, b] = t.edge[edge];
    const double ua = cuts_->u(a);
    const double ub = cuts_->u(b);
    double fraction = std::clamp(ua / (ua - ub), 0.0, 1.0);
    if (cuts_->cuts_finest()) {
        const double from_lower = cuts_->cut(edge).fraction;
        fraction = ua < ub ? from_lower : 1 - from_lower;
    }
    return t.reference[a] + fraction * (t.reference[b] - t.reference[a]);
}

/// \param corner or no_corner, for a vertex that lies at none
template <int dimension, class Real>
void ElementContour<dimension, Real>::put_at_node(Number vertex, std::size_t corner) {
    if (corner == ElementCuts<Real>::no_corner) return;
    const SurfaceCut node = cuts_->node(corner);
    surface_->put_at_node(vertex, {node.node[0], node.x}, node.attributes);
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::node_vertex(std::size_t corner) -> Number {
    if (on_corner_[corner] != none) return on_corner_[corner];
    const NodeKey key = cuts_->keys()[corner];
    const Number v = surface_->vertex_between({key, key}, [&] { return cuts_->node(corner); });
    if (options_->at_nodes && cuts_->u(corner) == 0) put_at_node(v, corner);
    return on_corner_[corner] = number_of(v, cuts_->view().topology().reference[corner]);
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::adopted(const TransitionContours& record, Number recorded,
                                              const FaceTopology& face) -> Number {
    const Point reference = options_->reference
                                ? reference_on_face(recorded_position(record, recorded), face)
                                : Point{};
    return number_of(of_record(record, recorded), reference);
}

/// The reference coordinates of a point on a face, by Newton's method on the map from the unit
/// square (triangle) to the face.
template <int dimension, class Real>
Point ElementContour<dimension, Real>::reference_on_face(const Point& x,
                                                         const FaceTopology& face) const {
    const auto blend = [&](const auto& of, double p, double q) {
        const auto at = [&](int i) { return of[face.tensor_corner(i)]; };
        if (face.corners == 3) return at(0) + p * (at(1) - at(0)) + q * (at(2) - at(0));
        return (1 - q) * ((1 - p) * at(0) + p * at(1)) + q * ((1 - p) * at(2) + p * at(3));
    };
    const auto& corner = cuts_->positions();
    double p = 1.0 / 3;
    double q = 1.0 / 3;
    for (int step = 0; step < 20; ++step) {
        const Point rest = x - blend(corner, p, q);
        const Point dp = blend(corner, p + 0.5, q) - blend(corner, p - 0.5, q);
        const Point dq = blend(corner, p, q + 0.5) - blend(corner, p, q - 0.5);
        const double pp = dot(dp, dp), pq = dot(dp, dq), qq = dot(dq, dq);
        const double determinant = pp * qq - pq * pq;
        if (determinant <= 0) break;
        p += (qq * dot(dp, rest) - pq * dot(dq, rest)) / determinant;
        q += (pp * dot(dq, rest) - pq * dot(dp, rest)) / determinant;
    }
    return blend(cuts_->view().topology().reference, p, q);
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::middle(std::span<const Number> of) -> Number {
    Point x{0, 0, 0};
    Point reference{0, 0, 0};
    const double weight = 1.0 / static_cast<double>(of.size());
    for (const Number v : of) {
        x = x + weight * position(v);
        if (wants_reference()) reference = reference + weight * reference_[v];
    }
    return number_of(surface_->add_unnamed(std::span(&x, 1), cuts_->attributes_at(reference)),
                     reference);
}

template <int dimension, class Real>
auto ElementContour<dimension, Real>::inside(const Point& reference) -> Number {
    const auto weight = shape_functions(cuts_->view().shape, reference);
    Point x{0, 0, 0};
    for (std::size_t i = 0; i < cuts_->view().corner_count(); ++i) {
        x = x + weight[i] * cuts_->positions()[i];
    }
    return number_of(surface_->add_unnamed(std::span(&x, 1), cuts_->attributes_at(reference)),
                     reference);
}

template class ElementContour<2, float>;
template class ElementContour<2, double>;
template class ElementContour<3, float>;
template class ElementContour<3, double>;

}  // namespace nestgrid::engine
