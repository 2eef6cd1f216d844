// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor for elements that stop without conforming: they record what finer
// elements draw on closed faces and what is left for the second walk, and let coarser elements
// adopt it.
#pragma once

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

template <int dimension, class Real, bool indexed>
bool IsosurfaceVisitor<dimension, Real, indexed>::must_record() const {
    if (dimension == 2) return false;
    const Hierarchy<Real>& hierarchy = walk_->hierarchy();
    if (hierarchy.offers(Feature::constrained) || bounds_->hanging() != nullptr) return true;
    if (dynamic_cast<const Exact*>(criterion_) != nullptr) return false;
    return hierarchy.offers(Feature::hidden) || !bounds_->stops_conform();
}

/// By the names of ways: where two have the same, more is entered.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::leave_for_later(const View& s) {
    if (s.father == nullptr) later_below_.insert(s.path, 0);
    for (const View* at = &s; at->father != nullptr; at = at->father) {
        NodeMask& children = *later_below_.insert(at->father->path, 0).first;
        if (std::exchange(children, children | NodeMask{1} << at->child) != 0) break;
    }
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::record(const View& s, Layer& layer,
                                                         unsigned pattern) {
    const Topology& t = s.topology();
    struct Segment {
        const ClosedFace* around;
        std::array<std::uint8_t, 2> edge;
    };
    std::array<Segment, 2 * max_faces> segments;
    std::size_t count = 0;
    unsigned edges = 0;
    unsigned closed = 0;
    for (std::size_t f = 0; f < t.faces; ++f) {
        closed |= unsigned{s.closed.face(f) != nullptr} << f;
    }
    for (unsigned left = closed & contours_of(s.shape).cut_faces(pattern); left != 0;
         left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const FaceTopology& face = t.face[f];
        unsigned signs = 0;
        for (std::size_t i = 0; i < face.corners; ++i) {
            signs |= (pattern >> face.corner[i] & 1U) << i;
        }
        const bool alternating = face.corners == 4 && (signs == 5 || signs == 10);
        const FaceContour& contour =
            face_contour(face.corners, signs, alternating && joined(s, face));
        const auto cut = [&](std::uint8_t side) {
            const std::uint8_t edge =
                edge_between(s.shape, face.corner[side], face.corner[(side + 1U) % face.corners]);
            edges |= 1U << edge;
            return edge;
        };
        for (std::size_t i = 0; i < contour.count; ++i) {
            std::array<std::uint8_t, 2> edge{cut(contour.segment[i].falls),
                                             cut(contour.segment[i].rises)};
            // A mirrored element sees its faces, and the segments on them, the other way round.
            if (s.orientation < 0) std::swap(edge[0], edge[1]);
            segments[count++] = {s.closed.face(f), edge};
        }
    }
    std::array<KeyPair, max_edges> names;  // all of them, so that none waits for another one's slot
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto e = static_cast<std::uint8_t>(std::countr_zero(left));
        names[e] = name(s, e);
        layer.transitions.expect(names[e]);
    }
    std::array<Number, max_edges> vertices;
    for (unsigned left = edges; left != 0; left &= left - 1) {
        const auto e = static_cast<std::uint8_t>(std::countr_zero(left));
        vertices[e] = layer.transitions.vertex(names[e], [&] { return make_cut(s, layer, e); });
    }
    for (const Segment& segment : std::span(segments).first(count)) {
        layer.transitions.record(segment.around, vertices[segment.edge[0]],
                                 vertices[segment.edge[1]], s.element(), s.shape, s.level);
    }
}

/// Cut faces on which a finer side recorded something, one bit each; on_face_ is their numbers.
template <int dimension, class Real, bool indexed>
unsigned IsosurfaceVisitor<dimension, Real, indexed>::recorded_faces(const View& s,
                                                                     const Layer& layer,
                                                                     unsigned pattern) {
    if (dimension == 2 || layer.drawn_below->empty()) return 0;
    const Topology& t = s.topology();
    std::array<NodeKey, max_corners> mixed;
    for (std::size_t i = 0; i < t.corners; ++i) mixed[i] = detail::mix(key_[i]);
    unsigned faces = 0;
    for (unsigned left = contours_of(s.shape).cut_faces(pattern); left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        FaceKey key;
        for (std::size_t i = 0; i < t.face[f].corners; ++i) {
            key.add_mixed(mixed[t.face[f].corner[i]]);
        }
        if (const Number* face = layer.drawn_below->find_face(key.key())) {
            on_face_[f] = *face;
            faces |= 1U << f;
        }
    }
    return faces;
}

/// What the finer side draws on a face from the cut of one of its sides, if anything.
/// \return whether there was something; is_joined is set by it on a face whose signs alternate
template <int dimension, class Real, bool indexed>
bool IsosurfaceVisitor<dimension, Real, indexed>::adopt(const View& s, Layer& layer, std::size_t on,
                                                        std::size_t side, unsigned signs,
                                                        bool& is_joined) {
    const FaceTopology& face = s.topology().face[on];
    const std::size_t n = face.corners;
    const auto edge_at = [&](std::size_t i) {
        return edge_between(s.shape, face.corner[i], face.corner[(i + 1) % n]);
    };
    const Number* from = layer.drawn_below->find(name(s, edge_at(side)));
    if (from == nullptr) return false;
    std::array<Number, 2> ends{none, none};
    std::array<std::size_t, 2> sides{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const unsigned there = signs >> i & 1U;
        const unsigned beyond = signs >> ((i + 1) % n) & 1U;
        if (there == beyond || there == (signs >> side & 1U)) continue;
        const Number* end = layer.drawn_below->find(name(s, edge_at(i)));
        if (end == nullptr) return false;
        sides[count] = i;
        ends[count++] = *end;
    }
    between_.clear();
    std::size_t end = 0;
    const bool found = layer.drawn_below->follow(
        on_face_[on], *from,
        [&](Number v) {
            if (v != ends[0] && v != ends[1]) return false;
            end = sides[v == ends[0] ? 0 : 1];
            return true;
        },
        [&](Number v) { between_.push_back(v); });
    if (!found) return false;
    // Loops run from where the sign rises to where it falls.
    const bool mirrored = s.orientation < 0;
    const std::size_t rises = mirrored ? end : side;
    const std::size_t falls = mirrored ? side : end;
    if (!between_.empty()) {
        if (mirrored) std::reverse(between_.begin(), between_.end());
        for (Number& v : between_) v = recorded(v, face);
        chained_ |= static_cast<std::uint16_t>(1U << edge_at(rises));
        chain_[edge_at(rises)].swap(between_);
    }
    is_joined = (falls + 1) % n == rises;
    return true;
}

/// Which alternating faces join their corners with U >= C, one bit each; loads the chains that the
/// finer sides drew.
template <int dimension, class Real, bool indexed>
unsigned IsosurfaceVisitor<dimension, Real, indexed>::choose(const View& s, Layer& layer,
                                                             unsigned pattern,
                                                             unsigned alternating) {
    unsigned joins = 0;
    for (unsigned left = alternating; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        if (joined(s, loop_of(s, f))) joins |= 1U << f;
    }
    const Topology& t = s.topology();
    for (unsigned left = recorded_; left != 0; left &= left - 1) {
        const auto f = static_cast<std::size_t>(std::countr_zero(left));
        const FaceTopology& face = t.face[f];
        unsigned signs = 0;
        for (std::size_t i = 0; i < face.corners; ++i) {
            signs |= (pattern >> face.corner[i] & 1U) << i;
        }
        for (std::size_t i = 0; i < face.corners; ++i) {
            // The finer side draws from where our segment comes back to where it leaves.
            const unsigned there = signs >> i & 1U;
            const unsigned beyond = signs >> ((i + 1U) % face.corners) & 1U;
            if (there == beyond || (there != 0) != (s.orientation < 0)) continue;
            bool is_joined = false;
            if (adopt(s, layer, f, i, signs, is_joined) && (alternating >> f & 1U) != 0) {
                joins = (joins & ~(1U << f)) | (unsigned{is_joined} << f);
            }
        }
    }
    return joins;
}

/// Around a vertex in the middle, so that no edge is one of an element.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::fill_gaps(Layer& layer) {
    layer_ = &layer;
    state_ = nullptr;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    for (const auto& gap : layer.transitions.gaps()) {
        if (counts_only_) forget_drawn(layer);
        local_.clear();
        reference_.clear();
        layer.sink.add_element(layer.transitions.element(gap.owner), gap.owner.shape,
                               gap.owner.level);
        Point x{0, 0, 0};
        std::vector<double> attributes(attribute_count_, 0.0);
        const double weight = 1.0 / static_cast<double>(gap.loop.size());
        for (const Number v : gap.loop) {
            const Cut cut = layer.transitions.cut(v);
            number_of(add({cut.node[0], cut.node[1]}, [&] { return cut; }),
                      {unknown, unknown, unknown});
            x = x + weight * cut.x;
            for (std::size_t i = 0; i < attribute_count_; ++i) {
                attributes[i] += weight * cut.attributes[i];
            }
        }
        const auto n = static_cast<Number>(local_.size());
        if (n == 3) {
            triangle(0, 1, 2);
            continue;
        }
        number_of(add_unnamed(x, attributes), {unknown, unknown, unknown});
        for (Number i = 0; i < n; ++i) triangle(i, (i + 1) % n, n);
    }
}

}  // namespace nestgrid::engine
