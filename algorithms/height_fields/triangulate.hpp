// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws a two-dimensional hierarchy as triangles, lifted along z by a scale times component 0.
// shading() and height_field() call it. Defined for float and double.
#pragma once

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/shading_options.hpp>

namespace nestgrid::engine {

/// \param scale of the heights; 0 for a shading
template <class Real>
Shading triangulate(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                    const Bounds& bounds, const ShadingOptions& options, const Executor& executor);
}  // namespace nestgrid::engine
