// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/transitions.hpp>

#include <algorithm>
#include <bit>

namespace nestgrid::engine {

namespace {

/// Whether the sign changes along a side of a face.
bool is_cut(unsigned signs, std::size_t side, std::size_t corners) {
    return (signs >> side & 1U) != (signs >> ((side + 1) % corners) & 1U);
}

}  // namespace

template <class Real>
void record_transitions(const ElementCuts<Real>& element, unsigned closed_faces, unsigned inside,
                        std::span<const std::uint32_t, max_edges> vertices,
                        TransitionContours& record) {
    const ElementView<Real>& view = element.view();
    for (unsigned left = closed_faces; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const FaceTopology& face = view.topology().face[f];
        const FaceContour& contour = element.contour(face, signs_of(face, inside));
        for (std::size_t i = 0; i < contour.count; ++i) {
            std::uint32_t from = vertices[edge_at(view.shape, face, contour.segment[i].falls)];
            std::uint32_t to = vertices[edge_at(view.shape, face, contour.segment[i].rises)];
            // A mirrored element sees the segments on its faces the other way round.
            if (view.orientation < 0) std::swap(from, to);
            record.record(view.closed.face(f), from, to, view.element(), view.shape, view.level);
        }
    }
}

template <int dimension, class Real>
bool TransitionAdoption<dimension, Real>::find(const TransitionContours& record,
                                               const Aside& aside) {
    faces_ = 0;
    record_ = &record;
    if (record.empty()) return false;
    for (unsigned left = aside.faces; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        if (const Number* face = record.find_face(aside.face_key[f])) {
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
auto TransitionAdoption<dimension, Real>::adopt(const Aside& aside, std::size_t on,
                                                std::size_t side, unsigned signs) -> Found {
    const FaceTopology& face = topology(aside.shape).face[on];
    const std::size_t n = face.corners;
    constexpr Number none = DrawnSurface<dimension>::none;
    std::array<Number, 2> ends{none, none};
    std::array<std::size_t, 2> sides{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        if (!is_cut(signs, i, n) || (signs >> i & 1U) == (signs >> side & 1U)) continue;
        sides[count] = i;
        ends[count++] = aside.vertex[edge_at(aside.shape, face, i)];
    }
    between_.clear();
    std::size_t end = 0;
    const bool found = record_->follow(
        on_face_[on], aside.vertex[edge_at(aside.shape, face, side)],
        [&](Number v) {
            if (v != ends[0] && v != ends[1]) return false;
            end = sides[v == ends[0] ? 0 : 1];
            return true;
        },
        [&](Number v) { between_.push_back(v); });
    if (!found) return Found::nothing;
    // Loops run from where the sign rises to where it falls.
    const std::size_t rises = aside.mirrored ? end : side;
    const std::size_t falls = aside.mirrored ? side : end;
    if (!between_.empty()) {
        if (aside.mirrored) std::reverse(between_.begin(), between_.end());
        for (Number& v : between_) v = contour_->adopted(*record_, v, face);
        contour_->set_chain(edge_at(aside.shape, face, rises), between_);
    }
    return (falls + 1) % n == rises ? Found::joined : Found::apart;
}

template <int dimension, class Real>
unsigned TransitionAdoption<dimension, Real>::choose(const Aside& aside) {
    unsigned joins = aside.joins;
    for (unsigned left = faces_; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const FaceTopology& face = topology(aside.shape).face[f];
        const unsigned signs = signs_of(face, aside.inside);
        for (std::size_t i = 0; i < face.corners; ++i) {
            // The finer side's segments run from the cut at which this element's segment comes back
            // to the one at which it leaves.
            const bool begins_inside = (signs >> i & 1U) != 0;
            if (!is_cut(signs, i, face.corners) || begins_inside != aside.mirrored) continue;
            const Found found = adopt(aside, f, i, signs);
            if (found == Found::nothing || !alternate(face.corners, signs)) continue;
            joins = (joins & ~(1U << f)) | (unsigned{found == Found::joined} << f);
        }
    }
    return joins;
}

template void record_transitions(const ElementCuts<float>&, unsigned, unsigned,
                                 std::span<const std::uint32_t, max_edges>, TransitionContours&);
template void record_transitions(const ElementCuts<double>&, unsigned, unsigned,
                                 std::span<const std::uint32_t, max_edges>, TransitionContours&);
template class TransitionAdoption<2, float>;
template class TransitionAdoption<2, double>;
template class TransitionAdoption<3, float>;
template class TransitionAdoption<3, double>;

}  // namespace nestgrid::engine
