// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction by several threads; included by isosurface_steps.hpp.
//
// Each task has a visitor of its own, which logs what it draws below its part of the frontier. The
// logs are repeated in the order of the parts, while later parts are drawn: vertices get their
// numbers, and gradients are added up, in the order of one thread. So the surface does not depend
// on the number of threads, nor on how the grid is cut, to the last bit. A sink that can be filled
// in parts (surface.hpp) takes the place of the log.
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
    if constexpr (!logs && !std::is_same_v<Executor, SequentialExecutor>) {
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
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        if constexpr (in_parts) {
            sinks.push_back(task ? std::move(task->layers_[i].sink) : layers_[i].sink.part());
        } else {
            const bool elements = keeps_elements(layers_[i].sink);
            sinks.push_back(task ? std::move(task->layers_[i].sink) : Log(elements));
            sinks.back().clear(elements);
        }
    }
    if (task) {
        task->begin_again(isovalues_, sinks);
    } else {
        task = std::make_unique<Task>(*walk_, isovalues_, std::move(sinks), *criterion_,
                                      *indicator_, idle_.silent);
    }
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
        if constexpr (in_parts) {
            layer.sink.append(part.sink);
        } else {
            repeat(layer, part.sink);
        }
    }
    if constexpr (in_parts) count_simplices(task.drawn_);
    if (options_->progress && !options_->progress(counts_)) throw Cancelled{};
}

NESTGRID_VISITOR::repeat(Layer& layer, const Log& log) -> void {
    struct Receiver {
        IsosurfaceVisitor* to;
        std::vector<Vertex>& known;
        std::span<const Point> points{};  // where there are no indices

        NESTGRID_INLINE void expect([[maybe_unused]] const std::array<NodeKey, 2>& node) const {
            if constexpr (indexed) {
                const VertexNumbers& numbers = to->layer_->number_of;
                numbers.prefetch(numbers.name({node[0], node[1]}));
            }
        }
        void cut(const typename Log::Cut& c) {
            known.push_back(to->add({c.node[0], c.node[1]}, [&] { return c; }));
        }
        void vertices(std::span<const Point> x, std::span<const double> attributes) {
            if constexpr (indexed) {
                const Number first = to->layer_->vertex_count;
                const std::size_t before = known.size();
                known.resize(before + x.size());
                std::iota(known.data() + before, known.data() + known.size(), first);
                to->add_unnamed(x, attributes);
            } else {
                points = x;
            }
        }
        void element(const typename Log::Owner& e) {
            to->layer_->sink.add_element(e.element, e.shape, e.level);
        }
        std::span<const Vertex> all_vertices() const {
            if constexpr (indexed) {
                return known;
            } else {
                return points;
            }
        }
        std::array<Vertex, static_cast<std::size_t>(dimension)> vertices_of(
            const typename Log::Simplex& corners) const {
            std::array<Vertex, static_cast<std::size_t>(dimension)> v;
            for (std::size_t k = 0; k < v.size(); ++k) v[k] = all_vertices()[corners[k]];
            return v;
        }
        void simplex(const typename Log::Simplex& corners, std::span<const Point> reference) {
            to->count_simplices(1);
            to->put_simplex(vertices_of(corners), reference);
        }
        void simplices(std::span<const typename Log::Simplex> all) {
            to->count_simplices(all.size());
            put_simplices<dimension>(to->layer_->sink, all_vertices(), all);
            add_areas(all);
        }
        void extracted(std::span<const typename Log::Owner> elements,
                       std::span<const typename Log::Simplex> all) {
            to->count_simplices(all.size());
            put_extracted<dimension>(to->layer_->sink, elements, all_vertices(), all);
            add_areas(all);
        }
        void add_areas(std::span<const typename Log::Simplex> all) {
            if (!to->options_->normals) return;
            for (const auto& corners : all) to->add_area(vertices_of(corners));
        }
        void boundary(typename Log::Ridge corners) {
            if constexpr (indexed) {
                for (auto& corner : corners) corner = known[corner];
                to->layer_->sink.add_boundary(corners);
            }
        }
    };
    layer_ = &layer;
    local_.clear();
    log.repeat(Receiver{this, local_});
}

}  // namespace nestgrid::detail

#undef NESTGRID_VISITOR
