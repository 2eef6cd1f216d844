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

/// Those of some faces of an element that are part of a closed face, one bit each.
template <class Real>
unsigned closed_among(const ClosedParts<Real>& closed, unsigned faces) {
    if (!closed.any_face) return 0;
    unsigned result = 0;
    for (unsigned left = faces; left != 0; left &= left - 1) {
        const auto f = lowest(left);
        result |= unsigned{closed.face(f) != nullptr} << f;
    }
    return result;
}

}  // namespace

template <int dimension, class Real>
void AsideContour<dimension, Real>::begin(unsigned inside, unsigned capped, bool put_aside) {
    const View& view = cuts_->view();
    const ContourTable& table = contour_->table(view.shape);
    const unsigned cut_edges = table.cut_edges(inside);
    unsigned cut_faces = table.cut_faces(inside);
    aside_.beyond = view.member->hidden == Hidden::wholly;
    aside_.inside = static_cast<std::uint8_t>(inside);
    aside_.capped = static_cast<std::uint8_t>(capped);
    aside_.faces = static_cast<std::uint8_t>(aside_.beyond ? 0U : cut_faces);
    aside_.edges = static_cast<std::uint16_t>(
        aside_.beyond ? cut_edges & edges_of(view.shape, capped) : cut_edges);
    put_aside_ = put_aside;
    // Beyond the other faces of a hidden element caps end where its neighbours draw them.
    if (options_->cap && aside_.beyond) cut_faces &= capped;
    closed_faces_ = closed_among(view.closed, cut_faces);
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::find_vertices(DrawnSurface<dimension>& surface,
                                                  const Contour* plain) {
    if (plain != nullptr) {
        aside_.vertex = contour_->plain_vertices(surface, *plain, aside_.inside);
        return;
    }
    contour_->begin(surface);
    const unsigned edges = contour_->table(cuts_->view().shape).cut_edges(aside_.inside);
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        aside_.vertex[edge] = contour_->of_surface(contour_->vertex(edge));
    }
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::find_vertices(TransitionContours& record) {
    const Shape shape = cuts_->view().shape;
    unsigned edges = put_aside_ ? aside_.edges : 0U;
    if (!put_aside_ || aside_.beyond) {
        edges |= edges_of(shape, closed_faces_) & contour_->table(shape).cut_edges(aside_.inside);
    }
    std::array<KeyPair, max_edges> names;  // fetched at once, so that none waits for another
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        names[edge] = cuts_->name(edge);
        record.expect(names[edge]);
    }
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        aside_.vertex[edge] = record.vertex(names[edge], [&] { return cuts_->cut(edge); });
    }
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::record(TransitionContours& record) {
    if (closed_faces_ != 0) {
        record_transitions(*cuts_, closed_faces_, aside_.inside, aside_.vertex, record);
    }
    if (aside_.capped != 0) cap_->record(aside_.inside, aside_.capped, record);
}

/// Completes what is kept of the element at hand.
template <int dimension, class Real>
void AsideContour<dimension, Real>::describe(unsigned boundary) {
    const View& view = cuts_->view();
    const ContourTable& table = contour_->table(view.shape);
    const unsigned alternating = aside_.beyond ? 0U : table.alternating(aside_.inside);
    aside_.level = static_cast<std::uint16_t>(view.level);
    aside_.shape = view.shape;
    aside_.mirrored = view.orientation < 0;
    aside_.joins = static_cast<std::uint8_t>(contour_->own_joins(alternating));
    aside_.boundary = static_cast<std::uint8_t>(aside_.beyond ? 0U : boundary);
    aside_.has_corners = options_->reference || options_->at_nodes || aside_.capped != 0 ||
                         table.plain(aside_.inside) == nullptr;
    if (aside_.has_corners) {
        aside_.key = cuts_->keys().data();
        aside_.x = cuts_->positions().data();
        aside_.value = view.value;
    }
    find_face_keys();
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::put_aside(const DrawnSurface<dimension>& surface,
                                              Transitions<Real>& transitions, unsigned boundary) {
    const View& view = cuts_->view();
    describe(boundary);
    std::array<NodeKey, max_edges> edge_keys;
    if (aside_.capped != 0) {
        for (std::uint8_t i = 0; i < view.topology().edges; ++i) edge_keys[i] = cap_->edge_key(i);
        aside_.edge_key = edge_keys.data();
    }
    transitions.asides.add(aside_);
    if (surface.builder().keeps_elements()) transitions.asides.add_handle(view.element());
    if (!aside_.beyond && !is_whole(view.shape, aside_.inside)) tally_->add_later(1);
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::find_face_keys() {
    const Topology& t = cuts_->view().topology();
    std::array<NodeKey, max_corners> mixed;
    for (std::size_t i = 0; i < t.corners; ++i) mixed[i] = nestgrid::detail::mix(cuts_->keys()[i]);
    for (unsigned left = aside_.faces; left != 0; left &= left - 1) {
        const auto f = lowest(left);
        FaceKey key;
        for (std::size_t i = 0; i < t.face[f].corners; ++i)
            key.add_mixed(mixed[t.face[f].corner[i]]);
        aside_.face_key[f] = key.key();
    }
}

template <int dimension, class Real>
void AsideContour<dimension, Real>::draw(DrawnSurface<dimension>& surface,
                                         Transitions<Real>& transitions, bool keeps_memory) {
    transitions.record.finish([&](std::uint32_t vertex) { return surface.position(vertex); });
    if (!surface.counts_only()) surface.builder().reserve_simplices(expected(transitions.asides));
    const auto draw_one = [&](const Aside& aside) { draw(surface, transitions, aside); };
    keeps_memory ? transitions.asides.for_each(draw_one) : transitions.asides.drain(draw_one);
    fill_gaps(surface, transitions.record);
}

/// About how many simplices elements that were put aside will have, and hardly ever less: as many
/// as they would draw without finer ones beside them, and some more.
template <int dimension, class Real>
std::size_t AsideContour<dimension, Real>::expected(const Asides<Real>& asides) const {
    std::size_t count = 0;
    asides.for_each([&](const Aside& aside) {
        const Contour* const plain = contour_->table(aside.shape).plain(aside.inside);
        count += plain == nullptr ? 4 : contour_->simplices_of(*plain);
    });
    return count + count / 16;
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
    take_vertices(record, aside);
    const unsigned joins = adopts ? adoption_.choose(aside) : aside.joins;
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
                           ? make_vertices(surface, transitions.record, aside)
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

/// Makes the vertices of an element whose cuts the record has.
/// \return their numbers in the surface, by edge
template <int dimension, class Real>
auto AsideContour<dimension, Real>::make_vertices(DrawnSurface<dimension>& surface,
                                                  const TransitionContours& record,
                                                  const Aside& aside) -> Vertices {
    Vertices vertices;
    for (unsigned left = aside.edges; left != 0; left &= left - 1) {
        const std::size_t edge = lowest(left);
        const SurfaceCut cut = record.cut(aside.vertex[edge]);
        vertices[edge] = surface.vertex_between({cut.node[0], cut.node[1]}, [&] { return cut; });
    }
    return vertices;
}

/// Gives the contour the vertices of an element that was put aside.
template <int dimension, class Real>
void AsideContour<dimension, Real>::take_vertices(const TransitionContours& record,
                                                  const Aside& aside) {
    for (unsigned left = aside.edges; left != 0; left &= left - 1) {
        const auto edge = lowest<std::uint8_t>(left);
        const std::uint32_t vertex = aside.vertex[edge];
        record.by_names() ? contour_->take_cut(edge, record.cut(vertex), aside.has_corners)
                          : contour_->take_vertex(edge, vertex, aside.has_corners);
    }
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
