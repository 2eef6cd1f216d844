// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/transitions.hpp>

#include <algorithm>
#include <bit>

namespace nestgrid::engine {

namespace {

/// Whether the sign changes along a side of a face.
bool is_cut(unsigned signs, std::size_t side, std::size_t corners) {
    return (signs >> side & 1U) != (signs >> ((side + 1) % corners) & 1U);
}

/// A face of an element; in two dimensions the element itself as a face.
template <int dimension>
FaceTopology loop_of(const Topology& topology, std::size_t face) {
    if (dimension == 2) return {Shape::quadrilateral, 4, {0, 1, 3, 2}};
    return topology.face[face];
}

/// The segments that an element draws on its closed faces, each from one of its edges to another.
class FaceSegments {
public:
    struct Segment {
        const ClosedFace* around;
        std::array<std::uint8_t, 2> edge;
    };

    template <class Real>
    FaceSegments(const ElementCuts<Real>& element, unsigned cut_faces, unsigned inside) {
        const ElementView<Real>& view = element.view();
        for (unsigned left = cut_faces; left != 0; left &= left - 1) {
            const auto f = static_cast<std::size_t>(std::countr_zero(left));
            const ClosedFace* around = view.closed.face(f);
            if (around == nullptr) continue;
            const FaceTopology& face = view.topology().face[f];
            const FaceContour& contour = element.contour(face, signs_of(face, inside));
            for (std::size_t i = 0; i < contour.count; ++i) {
                std::array<std::uint8_t, 2> edge{
                    edge_at(view.shape, face, contour.segment[i].falls),
                    edge_at(view.shape, face, contour.segment[i].rises)};
                // A mirrored element sees the segments on its faces the other way round.
                if (view.orientation < 0) std::swap(edge[0], edge[1]);
                edges_ |= 1U << edge[0] | 1U << edge[1];
                segment_[count_++] = {around, edge};
            }
        }
    }

    std::span<const Segment> all() const { return {segment_.data(), count_}; }
    unsigned edges() const { return edges_; }  ///< edges on which segments end, one bit each

private:
    std::array<Segment, 2 * max_faces> segment_;
    std::size_t count_ = 0;
    unsigned edges_ = 0;
};

}  // namespace

template <class Real>
void record_transitions(const ElementCuts<Real>& element, unsigned cut_faces, unsigned inside,
                        TransitionContours& record) {
    const FaceSegments segments(element, cut_faces, inside);
    const ElementView<Real>& view = element.view();
    std::array<KeyPair, max_edges> names;  // fetched at once, so that none waits for another
    for (unsigned left = segments.edges(); left != 0; left &= left - 1) {
        const auto e = static_cast<std::uint8_t>(std::countr_zero(left));
        names[e] = element.name(e);
        record.expect(names[e]);
    }
    std::array<TransitionContours::Index, max_edges> vertices;
    for (unsigned left = segments.edges(); left != 0; left &= left - 1) {
        const auto e = static_cast<std::uint8_t>(std::countr_zero(left));
        vertices[e] = record.vertex(names[e], [&] { return element.cut(e); });
    }
    for (const FaceSegments::Segment& segment : segments.all()) {
        record.record(segment.around, vertices[segment.edge[0]], vertices[segment.edge[1]],
                      view.element(), view.shape, view.level);
    }
}

template <int dimension, class Real>
bool TransitionAdoption<dimension, Real>::find(const TransitionContours* drawn_below,
                                               unsigned cut_faces) {
    faces_ = 0;
    if (dimension == 2 || drawn_below == nullptr || drawn_below->empty()) return false;
    drawn_below_ = drawn_below;
    const Topology& t = cuts_->view().topology();
    std::array<NodeKey, max_corners> mixed;
    for (std::size_t i = 0; i < t.corners; ++i) mixed[i] = nestgrid::detail::mix(cuts_->keys()[i]);
    for (unsigned left = cut_faces; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        FaceKey key;
        for (std::size_t i = 0; i < t.face[f].corners; ++i) {
            key.add_mixed(mixed[t.face[f].corner[i]]);
        }
        if (const Number* face = drawn_below->find_face(key.key())) {
            on_face_[f] = *face;
            faces_ |= 1U << f;
        }
    }
    return faces_ != 0;
}

/// Adopts the vertices that the finer side drew on face `on`, from the cut of a side of the face to
/// the cut of another side.
/// \return whether these segments join the corners inside the level; nothing where the finer side
///        drew none
template <int dimension, class Real>
auto TransitionAdoption<dimension, Real>::adopt(std::size_t on, std::size_t side, unsigned signs)
    -> Found {
    const ElementView<Real>& view = cuts_->view();
    const FaceTopology& face = view.topology().face[on];
    const std::size_t n = face.corners;
    const Number* from = drawn_below_->find(cuts_->name(edge_at(view.shape, face, side)));
    if (from == nullptr) return Found::nothing;
    constexpr Number none = LevelSurface<dimension>::none;
    std::array<Number, 2> ends{none, none};
    std::array<std::size_t, 2> sides{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!is_cut(signs, i, n) || (signs >> i & 1U) == (signs >> side & 1U)) continue;
        const Number* end = drawn_below_->find(cuts_->name(edge_at(view.shape, face, i)));
        if (end == nullptr) return Found::nothing;
        sides[count] = i;
        ends[count++] = *end;
    }
    between_.clear();
    std::size_t end = 0;
    const bool found = drawn_below_->follow(
        on_face_[on], *from,
        [&](Number v) {
            if (v != ends[0] && v != ends[1]) return false;
            end = sides[v == ends[0] ? 0 : 1];
            return true;
        },
        [&](Number v) { between_.push_back(v); });
    if (!found) return Found::nothing;
    // Loops run from where the sign rises to where it falls.
    const bool mirrored = view.orientation < 0;
    const std::size_t rises = mirrored ? end : side;
    const std::size_t falls = mirrored ? side : end;
    if (!between_.empty()) {
        if (mirrored) std::reverse(between_.begin(), between_.end());
        for (Number& v : between_) v = contour_->adopted(drawn_below_->cut(v), face);
        contour_->set_chain(edge_at(view.shape, face, rises), between_);
    }
    return (falls + 1) % n == rises ? Found::joined : Found::apart;
}

template <int dimension, class Real>
unsigned TransitionAdoption<dimension, Real>::choose(unsigned inside, unsigned alternating) {
    const ElementView<Real>& view = cuts_->view();
    const Topology& t = view.topology();
    unsigned joins = 0;
    for (unsigned left = alternating; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        if (cuts_->joined(loop_of<dimension>(t, f))) joins |= 1U << f;
    }
    for (unsigned left = faces_; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const FaceTopology& face = t.face[f];
        const unsigned signs = signs_of(face, inside);
        for (std::size_t i = 0; i < face.corners; ++i) {
            // The finer side's segments run from the cut at which this element's segment comes back
            // to the one at which it leaves.
            const bool begins_inside = (signs >> i & 1U) != 0;
            if (!is_cut(signs, i, face.corners) || begins_inside != (view.orientation < 0)) {
                continue;
            }
            const Found found = adopt(f, i, signs);
            if (found == Found::nothing || (alternating >> f & 1U) == 0) continue;
            joins = (joins & ~(1U << f)) | (unsigned{found == Found::joined} << f);
        }
    }
    return joins;
}

template void record_transitions(const ElementCuts<float>&, unsigned, unsigned,
                                 TransitionContours&);
template void record_transitions(const ElementCuts<double>&, unsigned, unsigned,
                                 TransitionContours&);
template class TransitionAdoption<2, float>;
template class TransitionAdoption<2, double>;
template class TransitionAdoption<3, float>;
template class TransitionAdoption<3, double>;

}  // namespace nestgrid::engine
