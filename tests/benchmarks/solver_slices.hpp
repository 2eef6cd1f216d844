// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What bench_solver_slices measures of each solver.
#pragma once

#include <string>

#include <nestgrid/detail/erase.hpp>

#include "slice_jumps.hpp"

struct SolverCase {
    std::string name;
    OnBoundary on_boundary;
    bool quick = false;  ///< every contestant runs once only
};

/// Two slices of a solution and isolines on them, beside VTK's filters on its leaves. Prints one
/// "name value" line per figure.
void measure_slices(const SolverCase& solver, const nestgrid::Hierarchy<double>& hierarchy);

/// Solve, each with a solver of its own, and measure. Those that need MPI begin and end it
/// themselves.
/// \param quick on a small grid
void slices_dealii(bool quick);
void slices_p4est(bool quick);
void slices_dune(bool quick);

/// Whether a point lies on the boundary of the box from 0 to `high`.
inline bool on_boundary_of_box(const nestgrid::Point& x, const nestgrid::Point& high) {
    constexpr double near = 1e-6;
    for (std::size_t d = 0; d < 3; ++d) {
        if (x[d] < near || x[d] > high[d] - near) return true;
    }
    return false;
}
