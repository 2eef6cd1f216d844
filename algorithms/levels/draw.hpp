// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Drives a LevelSet, for isosurfaces, series, budgets and other level sets.
#pragma once

#include <optional>

#include <levels/level_set.hpp>
#include <nestgrid/algorithms/isosurface.hpp>

namespace nestgrid::engine {

/// The first component of the field that an isosurface of component 0 carries along.
inline constexpr std::size_t isosurface_attributes = 1;

/// Draws each level into its builder, and sets all of its result but the surface.
/// \param bounds on the offsets of the components that the levels use
/// \param criterion has passed require_saturated()
template <int dimension, class Real>
void draw_levels(const Hierarchy<Real>& hierarchy, std::span<const Level<Real>> levels,
                 std::size_t first_attribute, std::span<const SurfaceBuilder<dimension>> builders,
                 const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
                 const Executor& executor, std::vector<Isosurface<dimension>>& results);

/// Runs a drawing. \return whether options.progress cancelled it
template <class Drawing>
bool run_until_cancelled(Drawing& drawing, const Executor& executor) {
    try {
        drawing.run(executor);
        return false;
    } catch (const Cancelled&) {
        return true;
    }
}

/// \throw InvalidInput where an isovalue is not a number
/// \throw GridError where the grid has changed since the bounds were computed
template <class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
                      const Bounds& bounds);

/// \throw InvalidInput where a criterion is not saturated on the grid of the bounds, and does not
///        insist
void require_saturated(const Criterion& criterion, const Bounds& bounds);

/// The number of triangles (segments) under a criterion, or nothing where it exceeds `most`.
/// \param options only cap and progress have an effect
template <int dimension, class Real>
std::optional<std::uint64_t> count_simplices(const Hierarchy<Real>& hierarchy, double isovalue,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor);

}  // namespace nestgrid::engine
