// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
// Drives a LevelSet, for isosurfaces, series, budgets and slices.
#pragma once

#include <memory>
#include <optional>

#include <drawing/requirements.hpp>
#include <level_sets/level_set.hpp>
#include <nestgrid/algorithms/detail/surface_targets.hpp>
#include <nestgrid/algorithms/least_threshold.hpp>
#include <nestgrid/algorithms/projection.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

/// The levels that one walk draws. The hierarchy and the functions are borrowed.
template <class Real>
struct Levels {
    const Hierarchy<Real>* hierarchy;
    std::vector<Level<Real>> levels;
    /// The first of the components that vertices carry: behind that of an isosurface.
    std::size_t first_attribute = 1;
    const PositionFunctions* functions = nullptr;  ///< the first components, or null
};

/// Replaces the levels by isosurfaces of component 0, and keeps the memory.
/// \throw InvalidInput where an isovalue is not a number
template <class Real>
void set_isovalues(Levels<Real>& levels, std::span<const double> isovalues);
template <class Real>
Levels<Real> isosurface_levels(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues);

/// Draws each level into its target, or into its result where there are no targets.
/// \param bounds of the data
/// \throw InvalidInput where the targets, the options or the criterion do not suit
/// \throw GridError where the grid has changed since the bounds were computed
template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_levels(
    const Levels<Real>& levels, const nestgrid::detail::SurfaceTargets<dimension>& targets,
    const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
    const Executor& executor);

/// \throw InvalidInput where vertices at nodes are asked for together with what excludes them
template <int dimension>
void require_options(const IsosurfaceOptions& options);

/// What require_sound() says, and what the options and distributed grids require.
/// \throw GridError, InvalidInput
template <int dimension, class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                      const Bounds& bounds, const IsosurfaceOptions& options);

/// What ranks compare before they draw levels.
template <class Real>
std::string asked_for(const Levels<Real>& levels, const Criterion& criterion,
                      const IsosurfaceOptions& options);

/// The number of triangles (segments) of all levels under a criterion, or nothing where there are
/// more than `most`.
/// \param options only cap and progress have an effect
template <int dimension, class Real>
std::optional<std::uint64_t> count_simplices(const Levels<Real>& levels, const Criterion& criterion,
                                             const Bounds& bounds, std::uint64_t most,
                                             const IsosurfaceOptions& options,
                                             const Executor& executor);

/// The least threshold at which all levels keep within a number of triangles. Those of slices are
/// counted before vertices are merged at nodes: a slice has no more.
/// \param bounds with the range of the data, at which the search begins
/// \throw InvalidInput where even the coarsest surface has more
template <int dimension, class Real>
TriangleBudget find_threshold(const Levels<Real>& levels, const CriterionAt& criterion_at,
                              const Bounds& bounds, std::uint64_t max_triangles,
                              const IsosurfaceOptions& options, const Executor& executor);

/// The same for the isosurfaces of component 0, all together.
/// \throw InvalidInput also where an isovalue is not a number, on all ranks alike
template <int dimension, class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
                              const CriterionAt& criterion_at, const Bounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor);

/// S from the threshold or the number of triangles of a projection.
/// \throw InvalidInput as find_threshold() and Projection::check()
template <int dimension, class Real>
Threshold criterion_for(const Levels<Real>& levels, const HierarchicalIndicator& indicator,
                        const Projection& projection, const IsosurfaceOptions& options,
                        const Executor& executor);

}  // namespace nestgrid::engine
