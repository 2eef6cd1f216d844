// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/triangulation.hpp>

#include <algorithm>
#include <bit>

#include <levels/error_bound.hpp>
#include <ranks/agreement.hpp>
#include <walk/walk_steps.hpp>

namespace nestgrid::engine {

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder)
    : graph_{graph},
      polygon_{*graph.walk, graph.shape},
      drawn_{{builder, graph.walk->hierarchy().facts().node_count}} {
    drawn_.nodes.begin(graph.walk->components());
    drawn_.surface.begin(builder, {}, false);
}

template <class Real>
void Triangulation<Real>::run(const Executor& executor,
                              const std::function<bool(const TraversalCounts&)>& progress) {
    if (progress) progress_ = &progress;
    const auto walk_alone = [&] { together(shared(), "triangles", [&] { walk(executor); }); };
    if (shared() != nullptr && !drawn_.surface.counts_only()) {
        drawn_.surface.keep_names(shared()->ranks().rank());
    }
    if (graph_.stops_apart) {
        records_ = true;
        walk_alone();
        records_ = false;
        restart();
        drawn_.tally.begin_later();
        if (shared() != nullptr) drawn_.nodes.exchange(*shared());
        drawn_.nodes.finish();
        if (!drawn_.nodes.empty()) nodes_ = &drawn_.nodes;
    }
    walk_alone();
}

/// Walks alone, or in tasks.
template <class Real>
void Triangulation<Real>::walk(const Executor& executor) {
    if (executor.concurrency() < 2) return graph_.walk->run_as(*this);
    std::vector<std::unique_ptr<Task>> tasks(most_tasks(executor));
    run_tasks<Real>(
        *graph_.walk, *this, executor,
        [&](std::size_t i) -> TaskVisitor<Real>& {
            tasks[i] = begin_task();
            return *tasks[i]->draws;
        },
        [&](std::size_t i) {
            count(tasks[i]->draws->drawn_.counts.calls);
            drawn_.add(tasks[i]->draws->drawn_, tasks[i]->part);
            tasks[i].reset();
        });
}

template <class Real>
auto Triangulation<Real>::begin_task() const -> std::unique_ptr<Task> {
    auto task = std::make_unique<Task>();
    task->part.surface.elements = graph_.walk->hierarchy().make_elements();
    task->draws = std::make_unique<Triangulation>(
        graph_, SurfaceBuilder<3>(task->part, true, graph_.elements));
    task->draws->records_ = records_;
    task->draws->nodes_ = nodes_;
    if (drawn_.surface.counts_only()) task->draws->count_only(drawn_.tally.limit());
    return task;
}

/// \throw Cancelled where progress says so
template <class Real>
void Triangulation<Real>::count(std::uint64_t elements) {
    const std::uint64_t before = drawn_.counts.calls;
    drawn_.counts.calls += elements;
    drawn_.counts.visited += elements;
    if (progress_ == nullptr || before >> 16U == drawn_.counts.calls >> 16U) return;
    if (!(*progress_)(drawn_.counts)) throw Cancelled{};
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
    if (records_ && !closed && !drawn_.tally.limited()) return {};
    return {which, 0};
}

/// Records the nodes on closed edges of an element, of which the second walk will draw one triangle
/// at least.
template <class Real>
void Triangulation<Real>::record(const View& view) {
    if (drawn_.tally.limited() && view.member->hidden != Hidden::wholly) drawn_.tally.add_later(1);
    if (!view.closed.any) return;
    polygon_.load(view);
    polygon_.record(drawn_.nodes);
}

template <class Real>
void Triangulation<Real>::extract(const View& view) {
    if (records_) return record(view);
    polygon_.load(view);
    const bool finest = view.level == graph_.bounds->finest_level();
    polygon_.draw(finest ? nullptr : nodes_, drawn_.surface);
    if (drawn_.surface.counts_only()) {
        drawn_.tally.add(drawn_.surface.builder().target()->simplices.size());
        return drawn_.surface.forget_element();
    }
    drawn_.surface.add_extracted(1);
    drawn_.surface.add_limited(view.inner_bounds().limited ? 1 : 0);
    raise_error_bound(view);
}

/// Adds up what S projected away below an element, the offsets of its interpolated corners, and
/// what its triangles leave out.
template <class Real>
void Triangulation<Real>::raise_error_bound(const View& view) {
    const float told = view.is_leaf() ? view.inner_bounds().error : 0;
    if (told > 0) return drawn_.surface.raise_error_bound(static_cast<double>(told));
    std::array<double, max_corners> u{};
    for (std::size_t i = 0; i < view.corner_count(); ++i) u[i] = polygon_.u(i);
    const Extent corners = Extent::of(std::span(u).first(view.corner_count()));
    const bool quadrilaterals = graph_.walk->hierarchy().facts().only_shape == Shape::quadrilateral;
    const double chord = polygon_.chord(view.is_leaf() || quadrilaterals);
    const Bounds& bounds = *graph_.bounds;
    const double off =
        projected_away(view, polygon_.keys(), view.is_leaf() ? 0 : below_, bounds, bounds);
    drawn_.surface.raise_error_bound(
        std::min(off + chord, greatest_difference(corners, corners, off, bounds)));
}

template <class Real>
void Triangulation<Real>::report(Shading& result) const {
    drawn_.report(result);
    const Bounds& bounds = *graph_.bounds;
    result.range_bound = greatest_difference({bounds.least(), bounds.greatest()}, bounds);
}

template class Triangulation<float>;
template class Triangulation<double>;

}  // namespace nestgrid::engine
