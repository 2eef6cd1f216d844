// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Members of IsosurfaceVisitor that draw by several threads.
//
// Each task has a visitor of its own, which draws a part of the surface below its part of the
// frontier (surface_part.hpp). The parts are put together in their order, while later ones are
// drawn: vertices get their numbers, and gradients are added up, in the order of one thread. So the
// surface does not depend on the number of threads, nor on how the grid is cut, to the last bit. A
// sink without indices that can be filled in parts (surface.hpp) is given those.
#pragma once

#include <memory>
#include <mutex>
#include <numeric>

#include <levels/isosurface_visitor.hpp>

namespace nestgrid::engine {

/// The list of elements in what a task draws.
template <int dimension>
Elements& elements_of(SurfacePart<dimension>& part) {
    return part.surface.elements;
}
template <int dimension>
Elements& elements_of(Soup<dimension>& part) {
    return part.elements;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::walk(const Executor& executor) {
    if (executor.concurrency() < 2) return walk_->run(*this);
    // Enough parts that threads end together, and few entries, for each begins anew.
    const std::size_t wanted = 16 * executor.concurrency();
    const Frontier<Real> frontier(*walk_, *this, 2 * wanted);
    const std::size_t entries = frontier.entry_count();
    const std::size_t parts = std::min(entries, wanted);
    idle_.silent = *options_;
    idle_.silent.progress = {};
    std::vector<std::unique_ptr<IsosurfaceVisitor>> tasks(parts);
    executor.run(
        parts,
        [&](std::size_t i) {
            tasks[i] = begin_task();
            frontier.run(*walk_, i * entries / parts, (i + 1) * entries / parts, *tasks[i]);
        },
        [&](std::size_t i) {
            add_task(*tasks[i]);
            const std::scoped_lock lock(idle_.mutex);
            idle_.tasks.push_back(std::move(tasks[i]));
        });
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::restart() {
    counts_ = {};
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::undo() {
    --counts_.calls;
    --counts_.visited;
}

/// A visitor for a task, with the memory of an earlier one where there is one.
template <int dimension, class Real, bool indexed>
auto IsosurfaceVisitor<dimension, Real, indexed>::begin_task()
    -> std::unique_ptr<IsosurfaceVisitor> {
    std::unique_ptr<IsosurfaceVisitor> task;
    {
        const std::scoped_lock lock(idle_.mutex);
        if (!idle_.tasks.empty()) {
            task = std::move(idle_.tasks.back());
            idle_.tasks.pop_back();
        }
    }
    std::vector<Part> parts;
    if (task) parts = std::move(task->parts_);
    if (parts.empty()) {
        parts.resize(layers_.size());
        for (Part& part : parts) elements_of(part) = walk_->hierarchy().make_elements();
    }
    std::vector<Builder> sinks;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        sinks.emplace_back(parts[i], layers_[i].sink.keeps_elements());
        sinks.back().clear();
    }
    if (task) {
        task->begin_again(isovalues_, sinks, *criterion_);
    } else {
        task = std::make_unique<IsosurfaceVisitor>(*walk_, isovalues_, std::move(sinks),
                                                   *criterion_, *bounds_, idle_.silent);
    }
    task->is_task_ = true;
    task->parts_ = std::move(parts);
    task->counts_only_ = counts_only_;
    task->recording_ = recording_;
    task->finishing_ = finishing_;
    task->limit_ = limit_;
    task->enter_ = enter_;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        task->layers_[i].drawn_below = layers_[i].drawn_below;
    }
    return task;
}

template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_task(IsosurfaceVisitor& task) {
    counts_.calls += task.counts_.calls;
    counts_.visited += task.counts_.visited;
    deepest_ = std::max(deepest_, task.deepest_);
    count_simplices(task.drawn_);
    if (drawn_ + (later_ += task.later_) > limit_) throw OverLimit{};
    task.later_below_.for_each(
        [&](NodeKey path, NodeMask children) { *later_below_.insert(path, 0).first |= children; });
    std::vector<Number> slot;
    for (const NodeKey node : task.gradients_.nodes()) slot.push_back(gradients_.slot(node));
    for (const auto& [at, g] : task.gradient_log_) add_gradient(slot[at], g);
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        Layer& layer = layers_[i];
        auto& part = task.layers_[i];
        layer.extracted += part.extracted;
        layer.error_bound = std::max(layer.error_bound, part.error_bound);
        if (recording_) layer.transitions.append(part.transitions);
        if (counts_only_) continue;
        if constexpr (indexed) {
            add_part(layer, task.parts_[i]);
            layer.sink.flush_if_full();
        } else {
            layer.sink.add_part(task.parts_[i]);
        }
    }
    if (options_->progress && !options_->progress(counts_)) throw Cancelled{};
}

/// Puts a part behind what is drawn. Its vertices get their numbers in the order in which it has
/// them, those that other parts know the same.
template <int dimension, class Real, bool indexed>
void IsosurfaceVisitor<dimension, Real, indexed>::add_part(
    Layer& layer, const SurfacePart<dimension>& part) requires(indexed) {
    constexpr std::size_t ahead = 16;
    layer_ = &layer;
    const auto& surface = part.surface;
    const std::span<const Point> x(surface.vertices);
    const std::span<const double> attributes(surface.attributes);
    std::vector<Number>& number = local_;  // here, of each of its vertices
    number.clear();
    const auto add_own = [&](std::size_t end) {
        const std::size_t first = number.size();
        if (first == end) return;
        number.resize(end);
        std::iota(number.data() + first, number.data() + end, layer.vertex_count);
        add_unnamed(x.subspan(first, end - first),
                    attributes.subspan(first * attribute_count_, (end - first) * attribute_count_));
    };
    const auto name = [&](const SharedVertex& v) {
        return layer.number_of.name({v.node[0], v.node[1]});
    };
    for (std::size_t i = 0; i < part.shared.size(); ++i) {
        if (i + ahead < part.shared.size()) {
            layer.number_of.prefetch(name(part.shared[i + ahead]));
        }
        const SharedVertex& v = part.shared[i];
        add_own(v.number);
        number.push_back(add_named(name(v), [&] {
            return Cut{x[v.number], v.node, v.fraction,
                       attributes.subspan(v.number * attribute_count_, attribute_count_)};
        }));
    }
    add_own(x.size());
    for (auto ridge : surface.boundary) {
        for (Number& v : ridge) v = number[v];
        layer.sink.add_boundary(ridge);
    }
    layer.sink.add_part(surface, number);
    if (!options_->normals) return;
    for (auto simplex : surface.simplices) {
        for (Number& v : simplex) v = number[v];
        add_area(simplex);
    }
}

}  // namespace nestgrid::engine
