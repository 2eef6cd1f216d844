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
      surface_{builder, graph.walk->hierarchy().facts().node_count},
      asides_{graph.walk->hierarchy().make_elements()} {
    recorded_.begin(graph.walk->components());
    surface_.begin(builder, {}, false);
}

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph)
    : Base(*graph.walk, {}),
      graph_{graph},
      polygon_{*graph.walk, graph.shape},
      surface_{{part_, true, graph.elements}, graph.walk->hierarchy().facts().node_count},
      asides_{graph.walk->hierarchy().make_elements()} {
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
    if (shared() != nullptr && !surface_.counts_only()) {
        surface_.keep_names(shared()->ranks().rank());
    }
    together(shared(), "triangles", [&] { Base::walk_elements(executor); });
    if (!graph_.stops_apart) return;
    if (shared() != nullptr) recorded_.exchange(*shared());
    together(shared(), "triangles", [&] { draw_asides(); });
}

template <class Real>
void Triangulation<Real>::walk_alone() {
    graph_.walk->run_as(*this);
}

template <class Real>
auto Triangulation<Real>::begin_part(std::unique_ptr<Base>) -> std::unique_ptr<Base> {
    auto part = std::make_unique<Triangulation>(graph_);
    if (surface_.counts_only()) part->count_only(tally_.limit());
    return part;
}

template <class Real>
void Triangulation<Real>::add(Base& part) {
    const auto& drawn = static_cast<const Triangulation&>(part);
    surface_.report().add(drawn.surface_.report());
    recorded_.append(drawn.recorded_);
    tally_.add(drawn.tally_);
    std::vector<std::uint32_t> numbers;
    if (!surface_.counts_only()) numbers = surface_.add_part(drawn.part_);
    asides_.append(drawn.asides_, numbers);
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
    if (decision.visit == Visit::stop) {
        below_ = graph_.bounds->bound(*split.rule, split.keys);
    }
    return decision;
}

template <class Real>
Leaves Triangulation<Real>::leaves(const Rule&, const Real*, NodeMask which, bool) {
    count(static_cast<std::uint64_t>(std::popcount(which)));
    return {which, 0};
}

template <class Real>
void Triangulation<Real>::extract(const View& view) {
    const bool hidden = view.member->hidden == Hidden::wholly;
    const bool records = graph_.stops_apart && view.closed.any;
    if (hidden && !records) return;
    polygon_.load(view);
    if (records) polygon_.record(recorded_);
    if (hidden) return;
    Polygon polygon = polygon_.polygon();
    if (graph_.stops_apart && view.level != graph_.bounds->finest_level()) {
        put_aside(view, polygon);
    } else if (surface_.counts_only()) {
        tally_.add(polygon.triangles(0));
    } else {
        polygon_.draw(polygon, surface_);
    }
    end_element(view, polygon);
}

/// Keeps the polygon of the element at hand.
template <class Real>
void Triangulation<Real>::put_aside(const View& view, Polygon& polygon) {
    const PolygonSides sides = polygon_.sides(polygon);
    if (surface_.counts_only()) {
        tally_.add_later(polygon.triangles(0));
    } else {
        polygon_.put_vertices(polygon, surface_);
    }
    asides_.add(polygon, sides);
    if (surface_.builder().keeps_elements()) asides_.add_handle(view.element());
}

/// Draws what was put aside, when all nodes on its sides are recorded.
template <class Real>
void Triangulation<Real>::draw_asides() {
    recorded_.finish();
    tally_.begin_later();
    asides_.for_each([&](const Polygon& polygon, const PolygonSides& sides, std::size_t number) {
        const NodesOnSides nodes{recorded_, sides};
        if (surface_.counts_only()) {
            std::uint64_t on_sides = 0;
            for (std::size_t i = 0; i < polygon.sides; ++i) on_sides += nodes.inside(i).size();
            return tally_.add(polygon.triangles(on_sides));
        }
        Handle element;
        if (surface_.builder().keeps_elements()) element = asides_.handle(number);
        polygon_.draw(polygon, element, &nodes, surface_);
    });
}

/// Counts an element and raises the bounds: adds up what S projected away below it, the offsets of
/// its interpolated corners, and what its triangles leave out.
template <class Real>
void Triangulation<Real>::end_element(const View& view, const Polygon& polygon) {
    if (surface_.counts_only()) return;
    DrawnReport& report = surface_.report();
    report.extracted += 1;
    const InnerBounds inner = view.inner_bounds();
    report.limited += inner.limited ? 1 : 0;
    report.raise_position_bound(static_cast<double>(inner.position_error));
    if (view.is_leaf() && inner.error > 0) {
        return report.raise_error_bound(static_cast<double>(inner.error));
    }
    std::array<double, max_corners> u{};
    for (std::size_t i = 0; i < view.corner_count(); ++i) u[i] = polygon_.u(i);
    const Extent corners = Extent::of(std::span(u).first(view.corner_count()));
    const bool quadrilaterals = graph_.walk->hierarchy().facts().only_shape == Shape::quadrilateral;
    const double chord = polygon_.chord(polygon, view.is_leaf() || quadrilaterals);
    const Bounds& bounds = *graph_.bounds;
    const double off =
        projected_away(view, polygon_.keys(), view.is_leaf() ? 0 : below_, bounds, bounds);
    report.raise_error_bound(
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
    result.table_bytes = surface_.memory_bytes() + asides_.memory_bytes();
    result.names = surface_.vertex_names();
    const Bounds& bounds = *graph_.bounds;
    result.range_bound = greatest_difference({bounds.least(), bounds.greatest()}, bounds);
}

template class Triangulation<float>;
template class Triangulation<double>;

}  // namespace nestgrid::engine
