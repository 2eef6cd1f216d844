// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction by several threads; included by isosurface_steps.hpp.
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

#include <nestgrid/algorithms/isosurface_visitor.hpp>

#define NESTGRID_VISITOR                                                     \
    template <class Grid, class Field, class S, class Indicator, class Sink> \
    auto IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>

namespace nestgrid::detail {

template <class Grid, class Field, class S, class Indicator, class Sink>
template <class Executor>
void IsosurfaceVisitor<Grid, Field, S, Indicator, Sink>::walk(const Executor& executor) {
    if (executor.concurrency() < 2) return walk_->run(*this);
    if constexpr (!std::is_same_v<Executor, SequentialExecutor>) {
        // Enough parts that threads end together, and few entries, for each begins anew.
        const std::size_t wanted = 16 * executor.concurrency();
        const Frontier frontier(*walk_, *this, 2 * wanted);
        const std::size_t entries = frontier.entry_count();
        const std::size_t parts = std::min(entries, wanted);
        idle_.silent = *options_;
        idle_.silent.progress = {};
        executor.run(
            parts,
            [&](std::size_t i) {
                std::unique_ptr<Task> task = begin_task();
                frontier.run(*walk_, i * entries / parts, (i + 1) * entries / parts, *task);
                return task;
            },
            [&](std::size_t, std::unique_ptr<Task> task) {
                add_task(*task);
                const std::scoped_lock lock(idle_.mutex);
                idle_.tasks.push_back(std::move(task));
            });
    }
}

NESTGRID_VISITOR::restart() -> void {
    counts_ = {};
}

NESTGRID_VISITOR::undo() -> void {
    --counts_.calls;
    --counts_.visited;
}

/// A visitor for a task, with the memory of an earlier one where there is one.
NESTGRID_VISITOR::begin_task() -> std::unique_ptr<Task> {
    std::unique_ptr<Task> task;
    {
        const std::scoped_lock lock(idle_.mutex);
        if (!idle_.tasks.empty()) {
            task = std::move(idle_.tasks.back());
            idle_.tasks.pop_back();
        }
    }
    std::vector<TaskSink> sinks;
    [[maybe_unused]] std::vector<Part> parts;
    if constexpr (indexed) {
        if (task) parts = std::move(task->parts_);
        parts.resize(layers_.size());
    }
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        [[maybe_unused]] const bool elements = keeps_elements(layers_[i].sink);
        if constexpr (indexed) {
            sinks.push_back(parts[i].begin(elements));
        } else if constexpr (in_parts) {
            sinks.push_back(task ? std::move(task->layers_[i].sink) : layers_[i].sink.part());
        } else {
            sinks.push_back(task ? std::move(task->layers_[i].sink) : TaskSink(elements));
            sinks.back().clear(elements);
        }
    }
    if (task) {
        task->begin_again(isovalues_, sinks);
    } else {
        task = std::make_unique<Task>(*walk_, isovalues_, std::move(sinks), *criterion_,
                                      *indicator_, idle_.silent);
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

NESTGRID_VISITOR::add_task(Task& task) -> void {
    counts_.calls += task.counts_.calls;
    counts_.visited += task.counts_.visited;
    deepest_ = std::max(deepest_, task.deepest_);
    count_simplices(task.drawn_);
    if (drawn_ + (later_ += task.later_) > limit_) throw OverLimit{};
    task.later_below_.for_each([&](NodeKey path, NodeMask children) {
        *later_below_.insert(path, 0).first |= children;
    });
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
        } else if constexpr (in_parts) {
            layer.sink.append(part.sink);
        } else {
            part.sink.repeat(layer.sink);
        }
    }
    if (options_->progress && !options_->progress(counts_)) throw Cancelled{};
}

/// Puts a part behind what is drawn. Its vertices get their numbers in the order in which it has
/// them, those that other parts know the same.
NESTGRID_VISITOR::add_part(Layer& layer, const Part& part) -> void {
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
                    attributes.subspan(first * attribute_count, (end - first) * attribute_count));
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
            Cut cut{x[v.number], v.node, v.fraction, {}};
            for (std::size_t k = 0; k < attribute_count; ++k) {
                cut.attributes[k] = attributes[v.number * attribute_count + k];
            }
            return cut;
        }));
    }
    add_own(x.size());
    for (auto ridge : surface.boundary) {
        for (Number& v : ridge) v = number[v];
        layer.sink.add_boundary(ridge);
    }
    put_part(layer.sink, surface, std::span<const Number>(number));
    if (!options_->normals) return;
    for (auto simplex : surface.simplices) {
        for (Number& v : simplex) v = number[v];
        add_area(simplex);
    }
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
