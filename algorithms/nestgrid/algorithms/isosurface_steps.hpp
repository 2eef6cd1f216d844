// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The steps of the extraction; included by isosurface_visitor.hpp.
#pragma once

#include <bit>
#include <limits>

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

template <class Grid, class Field, class S, class Indicator, class Sink>
IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::IsosurfaceVisitor(
    const Walk& walk, std::span<const double> isovalues, std::vector<Sink> sinks,
    const S& criterion, const Indicator& indicator, const IsosurfaceOptions& options)
    : walk_{&walk}, criterion_{&criterion}, indicator_{&indicator}, options_{&options},
      isovalues_{isovalues.begin(), isovalues.end()} {
    const std::size_t keys = dense_key_count(walk.grid());
    const bool small_keys = keys > 0 && keys <= (std::uint64_t{1} << 32U);
    for (Sink& sink : sinks) {
        layers_.push_back({{0, std::move(sink)}, 0, 0, VertexNumbers(small_keys)});
    }
    set_isovalues();
}

NESTGRID_VISITOR::set_isovalues() -> void {
    packed_criterion_ = packed_criterion(*criterion_);
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
    finest_ = -1;
    if constexpr (requires { indicator_->finest_level(); }) {
        if (must_record()) finest_ = indicator_->finest_level();
    }
    enter_ = &later_below_;
    plainly_ = attribute_count == 0 && !options_->cap && !options_->normals && !options_->reference;
    bisects_ =
        plainly_ && !layers_.empty() && knows_bisections_of_grid() && !must_record();
}

NESTGRID_VISITOR::begin_again(std::span<const double> isovalues, std::vector<Sink>& sinks) -> void {
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
    set_isovalues();
}

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Executor>
void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::run(const Executor& executor) {
    if (must_record()) {
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
        if constexpr (indexed) {
            if (options_->normals) set_normals(layer);
        }
    }
}

NESTGRID_VISITOR::table_bytes() const -> std::size_t {
    std::size_t bytes = gradients_.memory_bytes() + later_below_.memory_bytes();
    for (const Layer& layer : layers_) {
        bytes += layer.number_of.memory_bytes() + layer.within.memory_bytes() +
                 layer.transitions.memory_bytes() + layer.where.capacity() * sizeof(Where);
    }
    return bytes;
}

NESTGRID_VISITOR::pattern(const Real* value, std::size_t corners, const Layer& layer) const
    -> unsigned {
    unsigned bits = 0;
    for (std::size_t i = 0; i < corners; ++i) {
        bits |= unsigned{value[i * State::components] >= layer.least_inside} << i;
    }
    return bits;
}

NESTGRID_VISITOR::extract(const State& s) -> void {
    if (recording_ && finest_ < 0 && !s.closed.any && !limited()) return;
    if (finishing_ && s.level == finest_) return;
    const bool shown = !recording_ || !is_hidden(walk_->grid(), *s.context, s.element);
    const bool draws = !recording_ || (shown && s.level == finest_);
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const unsigned all = (1U << corners) - 1;
    const unsigned boundary = options_->cap ? walk_->boundary(s) : 0U;
    loaded_ = false;
    for (Layer& layer : layers_) {
        const unsigned bits = pattern(s.value.data(), corners, layer);
        if (bits == 0 || (bits == all && boundary == 0)) continue;
        if (shown && !draws) {
            if (bits != all && drawn_ + ++later_ > limit_) throw OverLimit{};
            if (finest_ >= 0) leave_for_later(s);
        }
        if (!draws && !s.closed.any) continue;
        load(s, draws);
        for (std::size_t i = 0; i < corners; ++i) {
            u_[i] = static_cast<double>(s.value[i * State::components]) - layer.isovalue;
        }
        state_ = &s;
        layer_ = &layer;
        if (recording_ && s.closed.any) {
            if (bits != all) record(s, layer, bits);
            if (boundary != 0) record_cap(s, layer, bits);
        }
        if (!draws) continue;
        recorded_ = recording_ ? 0 : recorded_faces(s, layer, bits);
        const Contour* plain = plainly_ ? plain_contour(s.shape, bits) : nullptr;
        unsigned joins = 0;
        chained_ = 0;
        if (plain == nullptr || recorded_ != 0) {
            begin_drawing();
            joins = choose(s, layer, bits, contours_of(s.shape).alternating(bits));
        }
        if (plain != nullptr && !chained()) {
            if (counts_only_) {
                count_simplices(simplices_of(*plain));
                continue;
            }
            draw_plainly(s, layer, plain, bits);
            add_error(s, layer);
            continue;
        }
        if (bits != all) draw(s, bits, joins);
        if (boundary != 0) draw_cap(s, layer, bits);
        if (begun_) add_error(s, layer);
        if (counts_only_) forget_drawn(layer);
    }
}

/// What was drawn of an element in order to count it.
NESTGRID_VISITOR::forget_drawn(Layer& layer) -> void {
    if constexpr (requires { layer.sink.clear(); }) layer.sink.clear();
    layer.vertex_count = 0;
}

NESTGRID_VISITOR::begin_drawing() -> void {
    begun_ = false;
    local_.clear();
    reference_.clear();
    on_edge_.fill(none);
    on_corner_.fill(none);
}

/// Keys and positions of the corners, and their gradients where the element is drawn.
NESTGRID_VISITOR::load(const State& s, bool draws) -> void {
    if (loaded_) return;
    loaded_ = true;
    walk_->keys(s, key_);
    walk_->positions(s, x_);
    deepest_ = std::max(deepest_, s.level);
    if (options_->normals && draws) load_gradients(s);
}

NESTGRID_VISITOR::add_error(const State& s, Layer& layer) const -> void {
    ++layer.extracted;
    double corner = 0;
    for (unsigned left = s.interpolated; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        corner = std::max(corner, indicator_->offset_bound(key_[i]));
    }
    // An interpolated parent that was made in the same split adds its own error.
    if (s.made_by != nullptr) corner *= s.made_by->steps;
    const auto corners = static_cast<std::size_t>(s.corner_count());
    const double chord =  // of a level that is not flat
        corners == static_cast<std::size_t>(dimension) + 1
            ? 0.0
            : 2 * affine_residual(std::span(x_).first(corners), std::span(u_).first(corners));
    layer.error_bound = std::max(
        layer.error_bound, static_cast<double>(element_bound_) + corner + chord);
}

/// Whether the corners with U >= C are joined across a face whose signs alternate.
NESTGRID_VISITOR::joined(const State&, const FaceTopology& face) const -> bool {
    return joins_across(u_[face.corner[0]], u_[face.corner[1]], u_[face.corner[2]],
                        u_[face.corner[3]]);
}

/// A face; in two dimensions the element itself as one.
NESTGRID_VISITOR::loop_of(const State& s, std::size_t face) -> FaceTopology {
    if constexpr (dimension == 2) {
        return {Shape::quadrilateral, 4, {0, 1, 3, 2}};
    } else {
        return s.topology().face[face];
    }
}

NESTGRID_VISITOR::draw(const State& s, unsigned pattern, unsigned joins) -> void {
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

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR

#include <nestgrid/algorithms/isosurface_cap.hpp>
#include <nestgrid/algorithms/isosurface_inspection.hpp>
#include <nestgrid/algorithms/isosurface_normals.hpp>
#include <nestgrid/algorithms/isosurface_tasks.hpp>
#include <nestgrid/algorithms/isosurface_transitions.hpp>
#include <nestgrid/algorithms/isosurface_vertices.hpp>
#include <nestgrid/algorithms/isosurface_plain.hpp>
#include <nestgrid/algorithms/isosurface_bisections.hpp>
