// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What bench_solvers measures of each solver. Those that need MPI have a file of their own, and
// begin and end it themselves: call them in a process that has not.
#pragma once

#include <chrono>

#include <nestgrid/algorithms/hierarchy_copy.hpp>
#include <nestgrid/algorithms/isosurface_series.hpp>

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Run {
    double first = 0;  // seconds, with everything a first surface needs
    double next = 0;   // seconds, another isovalue on the same data
    double bytes = 0;  // peak beside what was there before
    double triangles = 0;
    double visited = 0;
    double leaves = 0;
    double copied_next = 0;  // seconds, another isovalue of a copy
};

/// Two surfaces of a series, the first of them counted from `start`.
inline void time_series(nestgrid::IsosurfaceSeries<3>& series, double threshold,
                        Clock::time_point start, Run& run, const nestgrid::Executor& executor) {
    const nestgrid::Projection projection{.threshold = threshold};
    const nestgrid::IsosurfaceOptions options{.elements = false};
    const auto& result = series.draw(0.0, projection, options, executor);
    run.first = seconds_since(start);
    run.triangles = static_cast<double>(result.surface.simplices.size());
    run.visited = static_cast<double>(result.counts.visited);
    const auto again = Clock::now();
    series.draw(1e-3, projection, options, executor);
    run.next = seconds_since(again);
}

template <class Grid, class Field>
void time_isosurfaces(const Grid& grid, const Field& field, double threshold,
                      Clock::time_point start, Run& run,
                      const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
    nestgrid::IsosurfaceSeries series(grid, field, executor);
    time_series(series, threshold, start, run, executor);
}

/// The same of a copy of the hierarchy.
template <class Grid, class Field>
void time_copied(const Grid& grid, const Field& field, double threshold, Clock::time_point start,
                 Run& run, const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
    using Real = typename Field::value_type;
    auto copy = std::make_unique<const nestgrid::HierarchyCopy<Real>>(erase(grid, field));
    nestgrid::IsosurfaceSeries<3> series(
        std::unique_ptr<const nestgrid::Hierarchy<Real>>(std::move(copy)), executor);
    time_series(series, threshold, start, run, executor);
}

/// Two surfaces of the grid itself, and the second one of a copy.
template <class Grid, class Field>
Run time_both(const Grid& grid, const Field& field, Clock::time_point start) {
    Run run;
    time_isosurfaces(grid, field, 0, start, run);
    Run copied;
    time_copied(grid, field, 0, Clock::now(), copied);
    run.copied_next = copied.next;
    return run;
}

/// Hexahedra of a forest of p8est and tetrahedra of Dune's UGGrid, both refined at a sphere, with
/// all triangles. \param levels below the coarse grid: one tree, 384 tetrahedra
Run run_p4est(int levels);
Run run_dune_ug(int levels);
