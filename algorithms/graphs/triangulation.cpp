// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <graphs/triangulation.hpp>

#include <algorithm>
#include <bit>

#include <levels/level_set.hpp>

namespace nestgrid::engine {

namespace {

/// Whether all node keys of a hierarchy are below 2^32.
template <class Real>
bool has_small_keys(const Walk<Real>& walk) {
    const std::size_t keys = walk.hierarchy().facts().node_count;
    return keys > 0 && keys <= (std::uint64_t{1} << 32U);
}

}  // namespace

template <class Real>
Triangulation<Real>::Triangulation(const Graph<Real>& graph, const SurfaceBuilder<3>& builder)
    : graph_{graph},
      polygon_{*graph.walk, graph.shape},
      surface_{builder, has_small_keys(*graph.walk)} {
    own_nodes_.begin(graph.walk->components());
    surface_.begin(builder, nullptr, false);
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

/// Walks alone, or in tasks: enough of them that threads end together, and few, because a walk
/// begins anew at each.
template <class Real>
void Triangulation<Real>::walk(const Executor& executor) {
    if (executor.concurrency() < 2) return graph_.walk->run(*this);
    const std::size_t wanted = 16 * executor.concurrency();
    const Frontier<Real> frontier(*graph_.walk, *this, 2 * wanted);
    const std::size_t entries = frontier.entry_count();
    const std::size_t parts = std::min(entries, wanted);
    std::vector<std::unique_ptr<Task>> tasks(parts);
    executor.run(
        parts,
        [&](std::size_t i) {
            tasks[i] = begin_task();
            frontier.run(*graph_.walk, i * entries / parts, (i + 1) * entries / parts,
                         *tasks[i]->draws);
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
    return task;
}

template <class Real>
void Triangulation<Real>::add(const Task& task) {
    count(task.draws->counts_.calls);
    surface_.add_extracted(task.draws->surface_.extracted());
    surface_.raise_error_bound(task.draws->surface_.error_bound());
    if (records_) own_nodes_.append(task.draws->own_nodes_);
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

/// Does not ask a saturated criterion about an element with a corner at which S > 0, because S is 1
/// at all its new nodes then, unless one of them lies outside.
template <class Real>
Decision Triangulation<Real>::look(const View& view, const Split& split) {
    below_ = 0;
    if (split.rule == nullptr) return {Visit::stop, 0};
    Decision decision{Visit::stop, split.rule->all()};
    if (view.interpolated == 0 || split.outside != 0 || !graph_.criterion->saturated()) {
        decision = question_.ask(*graph_.walk, *graph_.criterion, view, split);
    }
    if (decision.visit == Visit::stop && !records_) {
        below_ = graph_.bounds->bound(*split.rule, split.keys);
    }
    return decision;
}

/// Extracts all leaves; in the first walk only those around which something may be closed.
template <class Real>
Leaves Triangulation<Real>::leaves(const Rule&, const Real*, NodeMask which, bool closed) {
    count(static_cast<std::uint64_t>(std::popcount(which)));
    if (records_ && !closed) return {};
    return {which, 0};
}

template <class Real>
void Triangulation<Real>::extract(const View& view) {
    if (records_ && !view.closed.any) return;
    polygon_.load(view);
    if (records_) return polygon_.record(own_nodes_);
    const bool finest = view.level == graph_.bounds->finest_level();
    polygon_.draw(finest ? nullptr : nodes_, surface_);
    surface_.add_extracted(1);
    raise_error_bound(view);
}

/// Adds up what S projected away below an element, the offsets of its interpolated corners, and
/// what its triangles leave out.
template <class Real>
void Triangulation<Real>::raise_error_bound(const View& view) {
    double corner = 0;
    for (unsigned left = view.interpolated; left != 0; left &= left - 1) {
        const NodeKey key = polygon_.keys()[static_cast<std::size_t>(std::countr_zero(left))];
        corner = std::max(corner, graph_.bounds->offset_bound(key));
    }
    // An interpolated parent that was made in the same split adds its own error.
    if (view.made_by != nullptr) corner *= view.made_by->steps;
    const bool quadrilaterals = graph_.walk->hierarchy().facts().only_shape == Shape::quadrilateral;
    const double chord = polygon_.chord(view.is_leaf() || quadrilaterals);
    surface_.raise_error_bound((view.is_leaf() ? 0 : below_) + corner + chord);
}

template class Triangulation<float>;
template class Triangulation<double>;

}  // namespace nestgrid::engine
