// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Drives an IsosurfaceVisitor: what isosurfaces, series and budgets have in common.
#pragma once

#include <optional>

#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid::engine {

/// \throw InvalidInput where an isovalue is not a number
/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
                      const Bounds& bounds);

/// \throw InvalidInput where a criterion is not saturated on the grid that the bounds are of, and
///        does not insist
void require_saturated(const Criterion& criterion, const Bounds& bounds);

/// Number of triangles (segments) under a criterion, or nothing where there are more than `most`.
/// \param options cap and progress count
template <int dimension, class Real>
std::optional<std::uint64_t> count_simplices(const Hierarchy<Real>& hierarchy, double isovalue,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor);

}  // namespace nestgrid::engine
