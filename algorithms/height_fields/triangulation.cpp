// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <height_fields/triangulation.hpp>

#include <algorithm>
#include <bit>

#include <drawing/differences.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder,
                                   const Progress& progress)
    : Base(*graph.walk, progress),
      graph_{graph},
      polygon_{*graph.walk, graph.shape},
      surface_{builder, graph.walk->hierarchy().facts().node_count} {
    recorded_.begin(graph.walk->components());
    surface_.begin(builder, {}, false);
}

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph)
    : Base(*graph.walk, {}),
      graph_{graph},
      polygon_{*graph.walk, graph.shape},
      surface_{{part_, true, graph.elements}, graph.walk->hierarchy().facts().node_count} {
    recorded_.begin(graph.walk->components());
    part_.surface.elements = graph.walk->hierarchy().make_elements();
    surface_.begin({part_, true, graph.elements}, {}, false);
}

template <class Real>
void Triangulation<Real>::count_only(std::uint64_t most) {
    Base::count_only(most);
    surface_.count_only();
}

template <class Real>
void Triangulation<Real>::run(const Executor& executor) {
    const auto walk = [&] {
        together(shared(), "triangles", [&] { Base::walk_elements(executor); });
    };
    if (shared() != nullptr && !surface_.counts_only()) {
        surface_.keep_names(shared()->ranks().rank());
    }
    if (graph_.stops_apart) {
        records_ = true;
        walk();
        records_ = false;
        this->restart();
        tally_.begin_later();
        if (shared() != nullptr) recorded_.exchange(*shared());
        recorded_.finish();
        if (!recorded_.empty()) nodes_ = &recorded_;
    }
    walk();
}

template <class Real>
void Triangulation<Real>::walk_alone() {
    graph_.walk->run_as(*this);
}

template <class Real>
auto Triangulation<Real>::begin_part(std::unique_ptr<Base>) -> std::unique_ptr<Base> {
    auto part = std::make_unique<Triangulation>(graph_);
    part->records_ = records_;
    part->nodes_ = nodes_;
    if (surface_.counts_only()) part->count_only(tally_.limit());
    return part;
}

template <class Real>
void Triangulation<Real>::add(Base& part) {
    const auto& drawn = static_cast<const Triangulation&>(part);
    surface_.report().add(drawn.surface_.report());
    recorded_.append(drawn.recorded_);
    tally_.add(drawn.tally_);
    if (!surface_.counts_only()) surface_.add_part(drawn.part_);
}

template <class Real>
void Triangulation<Real>::agree(Ranks& ranks) {
    surface_.agree(ranks);
    Base::agree(ranks);
}

/// \throw Cancelled where progress says so
template <class Real>
void Triangulation<Real>::count(std::uint64_t elements) {
    const std::uint64_t before = counts_.calls;
    Base::count(elements, elements);
    if (before >> 16U != counts_.calls >> 16U) Base::tell(0, 0);
}

template <class Real>
Decision Triangulation<Real>::inspect(const View& view, const Split& split) {
    counted_ = counted(view);
    count(counted_);
    return look(view, split);
}

template <class Real>
Decision Triangulation<Real>::look(const View& view, const Split& split) {
    below_ = 0;
    if (split.rule == nullptr) return {Visit::stop, 0};
    Decision decision{Visit::stop, split.rule->all()};
    if (!stops_by_saturation(graph_.criterion->saturated(), view, split)) {
        decision = question_.ask(*graph_.walk, *graph_.criterion, view, split);
    }
    if (decision.visit == Visit::stop && !records_) {
        below_ = graph_.bounds->bound(*split.rule, split.keys);
    }
    return decision;
}

/// Extracts all leaves; in the first walk only those around which something may be closed, unless
/// all are counted.
template <class Real>
Leaves Triangulation<Real>::leaves(const Rule&, const Real*, NodeMask which, bool closed) {
    count(static_cast<std::uint64_t>(std::popcount(which)));
    if (records_ && !closed && !tally_.limited()) return {};
    return {which, 0};
}

/// Records the nodes on closed edges of an element, of which the second walk will draw one triangle
/// at least.
template <class Real>
void Triangulation<Real>::record(const View& view) {
    if (tally_.limited() && view.member->hidden != Hidden::wholly) tally_.add_later(1);
    if (!view.closed.any) return;
    polygon_.load(view);
    polygon_.record(recorded_);
}

template <class Real>
void Triangulation<Real>::extract(const View& view) {
    if (records_) return record(view);
    polygon_.load(view);
    const bool finest = view.level == graph_.bounds->finest_level();
    polygon_.draw(finest ? nullptr : nodes_, surface_);
    if (surface_.counts_only()) {
        tally_.add(surface_.builder().target()->simplices.size());
        return surface_.forget_element();
    }
    DrawnReport& report = surface_.report();
    report.extracted += 1;
    const InnerBounds inner = view.inner_bounds();
    report.limited += inner.limited ? 1 : 0;
    report.raise_position_bound(static_cast<double>(inner.position_error));
    raise_error_bound(view);
}

/// Adds up what S projected away below an element, the offsets of its interpolated corners, and
/// what its triangles leave out.
template <class Real>
void Triangulation<Real>::raise_error_bound(const View& view) {
    const float told = view.is_leaf() ? view.inner_bounds().error : 0;
    if (told > 0) return surface_.report().raise_error_bound(static_cast<double>(told));
    std::array<double, max_corners> u{};
    for (std::size_t i = 0; i < view.corner_count(); ++i) u[i] = polygon_.u(i);
    const Extent corners = Extent::of(std::span(u).first(view.corner_count()));
    const bool quadrilaterals = graph_.walk->hierarchy().facts().only_shape == Shape::quadrilateral;
    const double chord = polygon_.chord(view.is_leaf() || quadrilaterals);
    const Bounds& bounds = *graph_.bounds;
    const double off =
        projected_away(view, polygon_.keys(), view.is_leaf() ? 0 : below_, bounds, bounds);
    surface_.report().raise_error_bound(
        std::min(off + chord, greatest_difference(corners, corners, off, bounds)));
}

template <class Real>
void Triangulation<Real>::report(Shading& result) const {
    result.counts = counts_;
    const DrawnReport& drawn = surface_.report();
    result.counts.extracted = drawn.extracted;
    result.counts.limited = drawn.limited;
    result.error_bound = drawn.error_bound;
    result.position_bound = drawn.position_bound;
    result.edge_nodes = recorded_.size();
    result.edge_nodes_bytes = recorded_.memory_bytes();
    result.table_bytes = surface_.memory_bytes();
    result.names = surface_.vertex_names();
    const Bounds& bounds = *graph_.bounds;
    result.range_bound = greatest_difference({bounds.least(), bounds.greatest()}, bounds);
}

template class Triangulation<float>;
template class Triangulation<double>;

}  // namespace nestgrid::engine
