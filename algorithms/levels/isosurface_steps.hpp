// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that begin, extract elements, and draw their contours.
#pragma once

#include <cmath>

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

template <int dimension, class Real, bool indexed>
IsosurfaceVisitor<dimension, Real, indexed>::IsosurfaceVisitor(
    const Walk<Real>& walk, std::span<const double> isovalues, std::vector<Builder> sinks,
    const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options)
    : walk_{&walk},
      bounds_{&bounds},
      own_bounds_{dynamic_cast<const HierarchicalIndicator*>(&bounds)},
      entries_{own_bounds_ == nullptr ? nullptr : &own_bounds_->entries()},
      options_{&options},
      components_{walk.components()},
      attribute_count_{components_ - 1},
      own_gradients_{walk.hierarchy().offers(Feature::gradients)},
      isovalues_{isovalues.begin(), isovalues.end()},
      attributes_(attribute_count_) {
    const std::size_t keys = walk.hierarchy().facts().node_count;
    const bool small_keys = keys > 0 && keys <= (std::uint64_t{1} << 32U);
    for (Builder& sink : sinks) {
        Layer& layer =
            layers_.emplace_back(Layer{{0, std::move(sink)}, 0, 0, VertexNumbers(small_keys)});
        layer.transitions.begin(attribute_count_, walk.hierarchy().make_elements());
    }
    set_isovalues(criterion);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::set_isovalues(const Criterion& criterion) {
    criterion_ = &criterion;
    own_threshold_ = dynamic_cast<const Threshold*>(&criterion);
    if (own_threshold_ != nullptr &&
        (own_bounds_ == nullptr || own_threshold_->indicator() != own_bounds_)) {
        own_threshold_ = nullptr;
    }
    if (own_threshold_ != nullptr) {
        packed_threshold_ = Pack<float>::all(float_below(own_threshold_->epsilon()));
    }
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        Layer& layer = layers_[i];
        layer.isovalue = isovalues_[i];
        auto least_inside = static_cast<Real>(layer.isovalue);
        if (static_cast<double>(least_inside) < layer.isovalue) {
            least_inside = std::nextafter(least_inside, std::numeric_limits<Real>::infinity());
        }
        layer.least_inside = least_inside;
        layer.greatest_outside =
            std::nextafter(least_inside, -std::numeric_limits<Real>::infinity());
        layer.packed_least_inside = Pack<Real>::all(layer.least_inside);
        layer.packed_greatest_outside = Pack<Real>::all(layer.greatest_outside);
        layer.drawn_below = &layer.transitions;
    }
    records_ = must_record();
    finest_ = records_ ? bounds_->finest_level() : -1;
    enter_ = &later_below_;
    plainly_ =
        attribute_count_ == 0 && !options_->cap && !options_->normals && !options_->reference;
    bisects_ = plainly_ && !layers_.empty() && walk_->hierarchy().facts().knows_blocks && !records_;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::begin_again(std::span<const double> isovalues,
                                                              std::vector<Builder>& sinks,
                                                              const Criterion& criterion) {
    recording_ = false;  // where the last one was cancelled
    finishing_ = false;
    restart();
    drawn_ = 0;
    later_ = 0;
    later_below_.clear();
    deepest_ = 0;
    gradients_.clear();
    gradient_log_.clear();
    isovalues_.assign(isovalues.begin(), isovalues.end());
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        Layer& layer = layers_[i];
        layer.sink = std::move(sinks[i]);
        layer.extracted = 0;
        layer.error_bound = 0;
        layer.number_of.clear();
        layer.within.begin_again(0);
        layer.transitions.clear();
        layer.where.clear();
        layer.vertex_count = 0;
    }
    set_isovalues(criterion);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::run(const Executor& executor) {
    if (records_) {
        recording_ = true;
        walk(executor);
        recording_ = false;
        finishing_ = finest_ >= 0;
        all_counts_ = counts_;
        restart();
        later_ = 0;
        for (Layer& layer : layers_) layer.transitions.finish();
    }
    walk(executor);
    for (Layer& layer : layers_) {
        fill_gaps(layer);
        layer.sink.flush();
        if constexpr (indexed) {
            if (options_->normals) set_normals(layer);
        }
    }
}

template <int dimension, class Real, bool indexed>
std::size_t IsosurfaceVisitor<dimension, Real, indexed>::table_bytes() const {
    std::size_t bytes = gradients_.memory_bytes() + later_below_.memory_bytes();
    for (const Layer& layer : layers_) {
        bytes += layer.number_of.memory_bytes() + layer.within.memory_bytes() +
                 layer.transitions.memory_bytes() + layer.where.capacity() * sizeof(Where);
    }
    return bytes;
}

/// The corners with U >= C, one bit each.
template <int dimension, class Real, bool indexed>
NESTGRID_INLINE unsigned IsosurfaceVisitor<dimension, Real, indexed>::pattern(
    const Real* value, std::size_t corners, const Layer& layer) const {
    unsigned bits = 0;
    if (components_ == 1 && corners == max_corners) {
        for (std::size_t i = 0; i < max_corners; ++i) {
            bits |= unsigned{value[i] >= layer.least_inside} << i;
        }
        return bits;
    }
    for (std::size_t i = 0; i < corners; ++i) {
        bits |= unsigned{value[i * components_] >= layer.least_inside} << i;
    }
    return bits;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::extract(const View& s) {
    if (s.is_leaf()) element_bound_ = 0;
    if (recording_ && finest_ < 0 && !s.closed.any && !limited()) return;
    if (finishing_ && s.level == finest_) return;
    const bool shown = !recording_ || s.member->hidden != Hidden::wholly;
    const bool draws = !recording_ || (shown && s.level == finest_);
    const std::size_t corners = s.corner_count();
    const unsigned all = (1U << corners) - 1;
    const unsigned boundary = options_->cap ? walk_->boundary(s) : 0U;
    loaded_ = false;
    for (Layer& layer : layers_) {
        const unsigned bits = pattern(s.value, corners, layer);
        if (bits == 0 || (bits == all && boundary == 0)) continue;
        if (shown && !draws) {
            if (bits != all && drawn_ + ++later_ > limit_) throw OverLimit{};
            if (finest_ >= 0) leave_for_later(s);
        }
        if (draws || s.closed.any) extract(s, layer, bits, boundary, draws);
    }
}

/// Records and draws the contour of one level set in an element.
/// \param bits the corners with U >= C
/// \param boundary the faces to be capped
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::extract(const View& s, Layer& layer,
                                                          unsigned bits, unsigned boundary,
                                                          bool draws) {
    load(s, draws);
    const std::size_t corners = s.corner_count();
    const unsigned all = (1U << corners) - 1;
    for (std::size_t i = 0; i < corners; ++i) {
        u_[i] = static_cast<double>(s.value[i * components_]) - layer.isovalue;
    }
    state_ = &s;
    layer_ = &layer;
    if (recording_ && s.closed.any) {
        if (bits != all) record(s, layer, bits);
        if (boundary != 0) record_cap(s, layer, bits);
    }
    if (!draws) return;
    recorded_ = recording_ ? 0 : recorded_faces(s, layer, bits);
    const Contour* plain = plainly_ ? plain_contour(s.shape, bits) : nullptr;
    unsigned joins = 0;
    chained_ = 0;
    if (plain == nullptr || recorded_ != 0) {
        begin_drawing();
        joins = choose(s, layer, bits, contours_of(s.shape).alternating(bits));
    }
    if (plain != nullptr && !chained()) {
        if (counts_only_) return count_simplices(simplices_of(*plain));
        draw_plainly(s, layer, plain, bits);
        add_error(s, layer);
        return layer.sink.flush_if_full();
    }
    if (bits != all) draw(s, bits, joins);
    if (boundary != 0) draw_cap(s, layer, bits);
    if (begun_) add_error(s, layer);
    if (counts_only_) {
        forget_drawn(layer);
    } else {
        layer.sink.flush_if_full();
    }
}

/// What was drawn of an element in order to count it.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::forget_drawn(Layer& layer) {
    layer.sink.clear();
    layer.vertex_count = 0;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::begin_drawing() {
    begun_ = false;
    local_.clear();
    reference_.clear();
    on_edge_.fill(none);
    on_corner_.fill(none);
}

/// Keys and positions of the corners, and their gradients where the element is drawn.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::load(const View& s, bool draws) {
    if (loaded_) return;
    loaded_ = true;
    const bool looks_up_faces = records_ && !recording_;
    const bool needs_keys = indexed || looks_up_faces || s.closed.any || s.interpolated != 0 ||
                            options_->normals || options_->cap;
    walk_->corners(s, needs_keys ? key_.data() : nullptr, x_.data());
    deepest_ = std::max(deepest_, s.level);
    if (options_->normals && draws) load_gradients(s);
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_error(const View& s, Layer& layer) const {
    ++layer.extracted;
    double corner = 0;
    for (unsigned left = s.interpolated; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        corner = std::max(corner, own_bounds_ != nullptr ? own_bounds_->offset_bound(key_[i])
                                                         : bounds_->offset_bound(key_[i]));
    }
    // An interpolated parent that was made in the same split adds its own error.
    if (s.made_by != nullptr) corner *= s.made_by->steps;
    const auto corners = s.corner_count();
    const double chord =  // of a level that is not flat
        corners == static_cast<std::size_t>(dimension) + 1
            ? 0.0
            : 2 * affine_residual(std::span(x_).first(corners), std::span(u_).first(corners));
    layer.error_bound =
        std::max(layer.error_bound, static_cast<double>(element_bound_) + corner + chord);
}

/// Whether the corners with U >= C are joined across a face whose signs alternate.
template <int dimension, class Real, bool indexed>
bool IsosurfaceVisitor<dimension, Real, indexed>::joined(const View&,
                                                         const FaceTopology& face) const {
    return joins_across(u_[face.corner[0]], u_[face.corner[1]], u_[face.corner[2]],
                        u_[face.corner[3]]);
}

/// A face; in two dimensions the element itself as one.
template <int dimension, class Real, bool indexed>
FaceTopology IsosurfaceVisitor<dimension, Real, indexed>::loop_of(const View& s, std::size_t face) {
    if constexpr (dimension == 2) {
        return {Shape::quadrilateral, 4, {0, 1, 3, 2}};
    } else {
        return s.topology().face[face];
    }
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::draw(const View& s, unsigned pattern,
                                                       unsigned joins) {
    const Contour& contour = contours_of(s.shape).at(pattern, joins);
    const unsigned boundary = walk_->boundary(s);
    if constexpr (dimension == 2) {
        for (std::size_t l = 0; l < contour.loop_count; ++l) {
            const ContourLoop& segment = contour.loop[l];
            const std::array<Number, 2> ends{vertex(segment.edge[0]), vertex(segment.edge[1])};
            simplex(ends);
            for (std::size_t i = 0; i < 2; ++i) {
                if ((boundary >> segment.face[i] & 1U) != 0) add_boundary({ends[i]});
            }
        }
    } else {
        ContourFilling<IsosurfaceVisitor> filling(*this);
        if (s.shape == Shape::hexahedron && contour.loop_count > 1) {
            const std::optional<Tunnel> tunnel = find_tunnel(contour, u_);
            tunnel ? filling.fill(contour, *tunnel) : filling.fill(contour);
        } else {
            filling.fill(contour);
        }
        for (std::size_t l = 0; boundary != 0 && l < contour.loop_count; ++l) {
            const ContourLoop& loop = contour.loop[l];
            for (std::size_t i = 0; i < loop.count; ++i) {
                if ((boundary >> loop.face[i] & 1U) == 0) continue;
                add_boundary({vertex(loop.edge[i]), vertex(loop.edge[(i + 1) % loop.count])});
            }
        }
    }
}

}  // namespace nestgrid::engine
