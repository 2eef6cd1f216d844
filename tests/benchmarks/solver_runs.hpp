// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What bench_solvers measures of each solver. Those that need MPI have a file of their own, and
// begin and end it themselves: call them in a process that has not.
#pragma once

#include <chrono>

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
};

/// Two surfaces of a series, the first of them counted from `start`.
template <class Grid, class Field>
void time_isosurfaces(const Grid& grid, const Field& field, double threshold,
                      Clock::time_point start, Run& run,
                      const nestgrid::Executor& executor = nestgrid::SequentialExecutor{}) {
    nestgrid::IsosurfaceSeries series(grid, field, executor);
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

/// Hexahedra of a forest of p8est and tetrahedra of Dune's UGGrid, both refined at a sphere, with
/// all triangles. \param levels below the coarse grid: one tree, 384 tetrahedra
Run run_p4est(int levels);
Run run_dune_ug(int levels);
