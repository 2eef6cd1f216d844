// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Draws level sets with several threads.
//
// Each task has a LevelSet of its own, which draws a part of the surfaces below its part of the
// frontier. The leader puts the parts together in their order, while tasks draw later ones: it
// numbers vertices and adds up gradients in the order of one thread. So no bit of the surface
// depends on the number of threads, or on where the frontier cuts the grid.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/isosurface_options.hpp>
#include <surfaces/surface_builder.hpp>

namespace nestgrid::engine {

template <int dimension, class Real>
class LevelSet;

/// Runs the walks of one LevelSet by tasks, and keeps the memory of tasks for later ones.
template <int dimension, class Real>
class LevelTasks {
public:
    /// Walks for `leader`, and adds everything to it.
    void run(LevelSet<dimension, Real>& leader, const Executor& executor);

private:
    struct Task {
        std::vector<SurfacePart<dimension>> parts;  // one a level
        std::unique_ptr<LevelSet<dimension, Real>> draws;
    };

    std::unique_ptr<Task> begin(const LevelSet<dimension, Real>& leader);
    static void add(const Task& task, LevelSet<dimension, Real>& leader);

    std::mutex mutex_;
    std::vector<std::unique_ptr<Task>> idle_;  // finished; later tasks use their memory
    IsosurfaceOptions silent_;                 // those of the leader without progress
};

}  // namespace nestgrid::engine
