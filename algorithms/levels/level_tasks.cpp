// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/level_tasks.hpp>

#include <algorithm>

#include <levels/level_set.hpp>

namespace nestgrid::engine {

template <int dimension, class Real>
void LevelTasks<dimension, Real>::run(LevelSet<dimension, Real>& leader, const Executor& executor) {
    silent_ = *leader.options_;
    silent_.progress = {};
    std::vector<std::unique_ptr<Task>> tasks(most_tasks(executor));
    run_tasks<Real>(
        *leader.walk_, leader, executor,
        [&](std::size_t i) -> TaskVisitor<Real>& {
            tasks[i] = begin(leader);
            return *tasks[i]->draws;
        },
        [&](std::size_t i) {
            add(*tasks[i], leader);
            const std::scoped_lock lock(mutex_);
            idle_.push_back(std::move(tasks[i]));
        });
}

template <int dimension, class Real>
auto LevelTasks<dimension, Real>::begin(const LevelSet<dimension, Real>& leader)
    -> std::unique_ptr<Task> {
    std::unique_ptr<Task> task;
    {
        const std::scoped_lock lock(mutex_);
        if (!idle_.empty()) {
            task = std::move(idle_.back());
            idle_.pop_back();
        }
    }
    if (!task) {
        task = std::make_unique<Task>();
        task->parts.resize(leader.surfaces_.size());
        for (auto& part : task->parts) {
            part.surface.elements = leader.walk_->hierarchy().make_elements();
        }
    }
    std::vector<SurfaceBuilder<dimension>> builders;
    for (std::size_t i = 0; i < leader.surfaces_.size(); ++i) {
        const auto& builder = leader.surfaces_[i].builder();
        builders.emplace_back(task->parts[i], builder.shares_vertices(), builder.keeps_elements());
        builders.back().clear();
    }
    if (task->draws) {
        task->draws->begin(*leader.search_, builders);
    } else {
        task->draws = std::make_unique<LevelSet<dimension, Real>>(
            *leader.walk_, *leader.search_, builders, silent_, leader.first_attribute_);
    }
    task->draws->join(leader);
    return task;
}

template <int dimension, class Real>
void LevelTasks<dimension, Real>::add(const Task& task, LevelSet<dimension, Real>& leader) {
    const LevelSet<dimension, Real>& drawn = *task.draws;
    leader.add(drawn.counts_.calls, drawn.counts_.visited);
    leader.deepest_ = std::max(leader.deepest_, drawn.deepest_);
    leader.tally_.add(drawn.tally_);
    leader.normals_.append(drawn.normals_);
    for (std::size_t i = 0; i < leader.surfaces_.size(); ++i) {
        LevelSurface<dimension>& surface = leader.surfaces_[i];
        surface.add_extracted(drawn.surfaces_[i].extracted());
        surface.add_limited(drawn.surfaces_[i].limited());
        surface.raise_error_bound(drawn.surfaces_[i].error_bound());
        surface.raise_off_level(drawn.surfaces_[i].off_level());
        surface.raise_leaf_error(drawn.surfaces_[i].leaf_error());
        surface.raise_position_bound(drawn.surfaces_[i].position_bound());
        std::vector<std::uint32_t> numbers;
        if (!surface.counts_only()) numbers = surface.add_part(task.parts[i], &drawn.surfaces_[i]);
        if (leader.records_) {
            auto& to = leader.transitions_[i];
            const auto& from = drawn.transitions_[i];
            numbers = to.record.append(from.record, std::move(numbers));
            to.asides.append(from.asides, numbers);
        }
        if (!surface.counts_only()) surface.builder().flush_if_full();
    }
    leader.report_progress(0, 0);
}

template class LevelTasks<2, float>;
template class LevelTasks<2, double>;
template class LevelTasks<3, float>;
template class LevelTasks<3, double>;

}  // namespace nestgrid::engine
