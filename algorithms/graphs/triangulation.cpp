// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/triangulation.hpp>

#include <algorithm>
#include <bit>

#include <levels/error_bound.hpp>

namespace nestgrid::engine {

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder)
    : graph_{graph},
      polygon_{*graph.walk, graph.shape},
      surface_{builder, graph.walk->hierarchy().facts().node_count} {
    own_nodes_.begin(graph.walk->components());
    surface_.begin(builder, nullptr, false);
}

template <class Real>
void Triangulation<Real>::count_only(std::uint64_t most) {
    tally_ = SimplexTally(most);
    surface_.count_only();
}

template <class Real>
void Triangulation<Real>::run(const Executor& executor,
                              const std::function<bool(const TraversalCounts&)>& progress) {
    if (progress) progress_ = &progress;
    if (graph_.stops_apart) {
        records_ = true;
        walk(executor);
        records_ = false;
        restart();
        tally_.begin_later();
        own_nodes_.finish();
        if (!own_nodes_.empty()) nodes_ = &own_nodes_;
    }
    walk(executor);
}

template <class Real>
void Triangulation<Real>::report(Shading& result) const {
    result.counts = counts_;
    result.counts.extracted = surface_.extracted();
    result.error_bound = surface_.error_bound();
    result.edge_nodes = own_nodes_.size();
    result.edge_nodes_bytes = own_nodes_.memory_bytes();
    result.table_bytes = surface_.memory_bytes();
}

/// Walks alone, or in tasks.
template <class Real>
void Triangulation<Real>::walk(const Executor& executor) {
    if (executor.concurrency() < 2) return graph_.walk->run(*this);
    std::vector<std::unique_ptr<Task>> tasks(most_tasks(executor));
    run_tasks<Real>(
        *graph_.walk, *this, executor,
        [&](std::size_t i) -> TaskVisitor<Real>& {
            tasks[i] = begin_task();
            return *tasks[i]->draws;
        },
        [&](std::size_t i) {
            add(*tasks[i]);
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
    if (surface_.counts_only()) task->draws->count_only(tally_.limit());
    return task;
}

template <class Real>
void Triangulation<Real>::add(const Task& task) {
    count(task.draws->counts_.calls);
    surface_.add_extracted(task.draws->surface_.extracted());
    surface_.raise_error_bound(task.draws->surface_.error_bound());
    if (records_) own_nodes_.append(task.draws->own_nodes_);
    tally_.add(task.draws->tally_);
    if (surface_.counts_only()) return;
    surface_.add_part(task.part);
}

/// \throw Cancelled where progress says so
template <class Real>
void Triangulation<Real>::count(std::uint64_t elements) {
    const std::uint64_t before = counts_.calls;
    counts_.calls += elements;
    counts_.visited += elements;
    if (progress_ == nullptr || before >> 16U == counts_.calls >> 16U) return;
    if (!(*progress_)(counts_)) throw Cancelled{};
}

template <class Real>
Decision Triangulation<Real>::inspect(const View& view, const Split& split) {
    count(1);
    return look(view, split);
}

template <class Real>
Decision Triangulation<Real>::look(const View& view, const Split& split) {
    below_ = 0;
    if (split.rule == nullptr) return {Visit::stop, 0};
    Decision decision{Visit::stop, split.rule->all()};
    if (!stops_unasked(graph_.criterion->saturated(), view, split)) {
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
    polygon_.record(own_nodes_);
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
    surface_.add_extracted(1);
    raise_error_bound(view);
}

/// Adds up what S projected away below an element, the offsets of its interpolated corners, and
/// what its triangles leave out.
template <class Real>
void Triangulation<Real>::raise_error_bound(const View& view) {
    const double corner = corner_offset(view, polygon_.keys(), *graph_.bounds);
    const bool quadrilaterals = graph_.walk->hierarchy().facts().only_shape == Shape::quadrilateral;
    const double chord = polygon_.chord(view.is_leaf() || quadrilaterals);
    surface_.raise_error_bound((view.is_leaf() ? 0 : below_) + corner + chord);
}

template class Triangulation<float>;
template class Triangulation<double>;

}  // namespace nestgrid::engine
