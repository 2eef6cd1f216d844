// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/aside_contour.hpp>

#include <bit>

#include <level_sets/element_contour_steps.hpp>

namespace nestgrid::engine {

namespace {

/// The number of the lowest bit that is set.
template <class Number = std::size_t>
Number lowest(unsigned bits) {
    return static_cast<Number>(std::countr_zero(bits));
}

/// The edges around some faces, one bit each.
unsigned edges_of(Shape shape, unsigned faces) {
    unsigned edges = 0;
    for (unsigned left = faces; left != 0; left &= left - 1) {
        const FaceTopology& face = topology(shape).face[lowest(left)];
        for (std::size_t i = 0; i < face.corners; ++i) edges |= 1U << edge_at(shape, face, i);
    }
    return edges;
}

/// Whether all corners of an element are inside a level, and not some.
bool is_whole(Shape shape, unsigned inside) {
    return inside == (1U << topology(shape).corners) - 1;
}

}  // namespace

template <int dimension, class Real>
auto AsideContour<dimension, Real>::find_vertices(DrawnSurface<dimension>& surface,
                                                  const Contour* plain, unsigned inside)
    -> Vertices {
    if (plain != nullptr) return contour_->plain_vertices(surface, *plain, inside);
    contour_->begin(surface);
    Vertices vertices;
    const unsigned edges = contour_->table(cuts_->view().shape).cut_edges(inside);
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        vertices[edge] = contour_->of_surface(contour_->vertex(edge));
    }
    return vertices;
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::record(TransitionContours& record, unsigned inside,
                                           unsigned capped, const Vertices& vertices) {
    const View& view = cuts_->view();
    if (!is_whole(view.shape, inside)) {
        // Beyond the other faces of a hidden element caps end where its neighbours draw them.
        const bool some = options_->cap && view.member->hidden == Hidden::wholly;
        const unsigned cut_faces = contour_->table(view.shape).cut_faces(inside);
        record_transitions(*cuts_, some ? cut_faces & capped : cut_faces, inside, vertices, record);
    }
    if (capped != 0) cap_->record(inside, capped, record);
}

/// The element at hand, without what is kept of it in lists.
template <int dimension, class Real>
AsideElement AsideContour<dimension, Real>::describe(unsigned inside, unsigned capped,
                                                     unsigned boundary) const {
    const View& view = cuts_->view();
    const ContourTable& table = contour_->table(view.shape);
    AsideElement e{};
    e.level = static_cast<std::uint16_t>(view.level);
    e.shape = view.shape;
    e.inside = static_cast<std::uint8_t>(inside);
    e.mirrored = view.orientation < 0;
    e.beyond = view.member->hidden == Hidden::wholly;
    e.capped = static_cast<std::uint8_t>(capped);
    unsigned edges = table.cut_edges(inside);
    if (e.beyond) edges &= edges_of(view.shape, capped);
    e.edges = static_cast<std::uint16_t>(edges);
    e.has_corners =
        options_->reference || options_->at_nodes || capped != 0 || table.plain(inside) == nullptr;
    if (e.beyond) return e;
    e.faces = static_cast<std::uint8_t>(table.cut_faces(inside));
    e.joins = static_cast<std::uint8_t>(contour_->own_joins(table.alternating(inside)));
    e.boundary = static_cast<std::uint8_t>(boundary);
    return e;
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::put_aside(const DrawnSurface<dimension>& surface,
                                              Transitions<Real>& transitions, unsigned inside,
                                              unsigned capped, unsigned boundary,
                                              const Vertices& vertices) {
    const View& view = cuts_->view();
    Asides<Real>& asides = transitions.asides;
    const AsideElement e = describe(inside, capped, boundary);
    asides.add(e);
    keep_vertices(transitions, e.edges, surface.counts_only(), vertices);
    keep_face_keys(asides, e.faces);
    if (e.has_corners) {
        asides.add_corners(std::span(cuts_->keys()).first(view.corner_count()),
                           cuts_->positions().data(), view.value);
    }
    if (e.capped != 0) {
        std::array<NodeKey, max_edges> keys;
        const std::uint8_t edges = view.topology().edges;
        for (std::uint8_t i = 0; i < edges; ++i) keys[i] = cap_->edge_key(i);
        asides.add_edge_keys(std::span(keys).first(edges));
    }
    if (surface.builder().keeps_elements()) asides.add_handle(view.element());
    if (!e.beyond && !is_whole(e.shape, inside)) tally_->add_later(1);
}

/// Keeps the vertices on some edges: their numbers, or else their cuts; where simplices are only
/// counted, the names of these.
template <int dimension, class Real>
void AsideContour<dimension, Real>::keep_vertices(Transitions<Real>& transitions, unsigned edges,
                                                  bool counts_only,
                                                  const Vertices& vertices) const {
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        if (!transitions.record.by_names()) {
            transitions.asides.add_vertex(vertices[edge]);
        } else if (counts_only) {
            transitions.asides.add_name(cuts_->name(edge));
        } else {
            transitions.asides.add_cut(cuts_->cut(edge));
        }
    }
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::keep_face_keys(Asides<Real>& asides, unsigned faces) const {
    const Topology& t = cuts_->view().topology();
    std::array<NodeKey, max_corners> mixed;
    for (std::size_t i = 0; i < t.corners; ++i) mixed[i] = nestgrid::detail::mix(cuts_->keys()[i]);
    for (unsigned left = faces; left != 0; left &= left - 1) {
        const FaceTopology& face = t.face[lowest(left)];
        FaceKey key;
        for (std::size_t i = 0; i < face.corners; ++i) key.add_mixed(mixed[face.corner[i]]);
        asides.add_face_key(key.key());
    }
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::draw(DrawnSurface<dimension>& surface,
                                         Transitions<Real>& transitions) {
    transitions.record.finish([&](std::uint32_t vertex) { return surface.position(vertex); });
    transitions.asides.for_each([&](const Aside& aside) { draw(surface, transitions, aside); });
    fill_gaps(surface, transitions.record);
}

/// Draws an element that was put aside.
template <int dimension, class Real>
void AsideContour<dimension, Real>::draw(DrawnSurface<dimension>& surface,
                                         const Transitions<Real>& transitions, const Aside& aside) {
    const TransitionContours& record = transitions.record;
    const bool adopts = adoption_.find(record, aside);
    if (!adopts && !aside.has_corners) {
        const Contour& plain = *contour_->table(aside.shape).plain(aside.inside);
        return draw_plainly(surface, transitions, aside, plain);
    }
    load(surface.builder().keeps_elements(), transitions.asides, aside);
    aside.beyond ? contour_->begin_beyond(surface) : contour_->begin(surface);
    const Names names = take_vertices(transitions, aside);
    const unsigned joins = adopts ? adoption_.choose(aside, names) : aside.joins;
    if (!aside.beyond && !is_whole(aside.shape, aside.inside)) {
        contour_->draw(aside.inside, joins, aside.boundary);
    }
    if (aside.capped != 0) cap_->draw(aside.inside, aside.capped, {&record, aside.edge_key});
    if (surface.counts_only()) return surface.forget_element();
    surface.builder().flush_if_full();
}

/// Draws an element on whose faces nothing was recorded, and whose corners do not matter.
template <int dimension, class Real>
void AsideContour<dimension, Real>::draw_plainly(DrawnSurface<dimension>& surface,
                                                 const Transitions<Real>& transitions,
                                                 const Aside& aside, const Contour& plain) {
    if (surface.counts_only()) return tally_->add(contour_->simplices_of(plain));
    if (surface.builder().keeps_elements()) {
        surface.builder().add_element(transitions.asides.handle(aside), aside.shape, aside.level);
    }
    const Vertices v = transitions.record.by_names()
                           ? make_vertices(surface, transitions.asides, aside)
                           : aside.vertex;
    contour_->draw_between(surface, plain, v, aside.mirrored, aside.boundary);
    surface.builder().flush_if_full();
}

/// Makes an element that was put aside the one at hand.
template <int dimension, class Real>
void AsideContour<dimension, Real>::load(bool keeps_elements, const Asides<Real>& asides,
                                         const Aside& aside) {
    if (keeps_elements) member_.element = asides.handle(aside);
    view_.member = &member_;
    view_.value = aside.value;
    view_.shape = aside.shape;
    view_.level = aside.level;
    view_.orientation = aside.mirrored ? -1 : 1;
    cuts_->reload(view_, aside.has_corners ? aside.key : nullptr, aside.x);
}

/// Makes the vertices of an element whose cuts were kept.
/// \return their numbers in the surface, by edge
template <int dimension, class Real>
auto AsideContour<dimension, Real>::make_vertices(DrawnSurface<dimension>& surface,
                                                  const Asides<Real>& asides,
                                                  const Aside& aside) const -> Vertices {
    Vertices vertices;
    for (unsigned left = aside.edges; left != 0; left &= left - 1) {
        const std::size_t edge = lowest(left);
        const SurfaceCut cut = asides.cut(aside.vertex[edge]);
        vertices[edge] = surface.vertex_between({cut.node[0], cut.node[1]}, [&] { return cut; });
    }
    return vertices;
}

/// Gives the contour the vertices of an element that was put aside.
/// \return by edge, the nodes around each, where the record knows vertices by these
template <int dimension, class Real>
auto AsideContour<dimension, Real>::take_vertices(const Transitions<Real>& transitions,
                                                  const Aside& aside) -> Names {
    Names names;
    for (unsigned left = aside.edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        if (!transitions.record.by_names()) {
            contour_->take_vertex(edge, aside.vertex[edge], aside.has_corners);
            continue;
        }
        const SurfaceCut cut = transitions.asides.cut(aside.vertex[edge]);
        names[edge] = KeyPair(cut.node[0], cut.node[1]);
        contour_->take_cut(edge, cut, aside.has_corners);
    }
    return names;
}

/// Draws the polygons in faces that their two sides divide in different directions.
template <int dimension, class Real>
void AsideContour<dimension, Real>::fill_gaps(DrawnSurface<dimension>& surface,
                                              const TransitionContours& record) {
    for (const TransitionContours::Gap& gap : record.gaps()) {
        if (surface.counts_only()) surface.forget_element();
        contour_->fill_gap(surface, record, gap);
    }
}

template class AsideContour<2, float>;
template class AsideContour<2, double>;
template class AsideContour<3, float>;
template class AsideContour<3, double>;

}  // namespace nestgrid::engine
