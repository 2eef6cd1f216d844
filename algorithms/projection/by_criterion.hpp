// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Draws a hierarchy under a criterion: what every projection of a field comes to. Each is defined
// for float and double, and throws as the public function of its name.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <nestgrid/algorithms/executor.hpp>
#include <nestgrid/algorithms/indicator.hpp>
#include <nestgrid/algorithms/isolines.hpp>
#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/algorithms/shading_options.hpp>
#include <nestgrid/algorithms/slices.hpp>

namespace nestgrid::engine {

/// \param targets none: the surfaces are in the results
template <int dimension, class Real>
std::vector<Isosurface<dimension>> isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
    const nestgrid::detail::SurfaceTargets<dimension>& targets, const Criterion& criterion,
    const Bounds& bounds, const IsosurfaceOptions& options, const Executor& executor);

template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const Criterion& criterion, const Bounds& bounds,
                                 const IsosurfaceOptions& options, const Executor& executor) {
    return std::move(isosurfaces<dimension>(hierarchy, std::span<const double>(&isovalue, 1), {},
                                            criterion, bounds, options, executor)
                         .front());
}

/// \throw InvalidInput unless low < high, and for caps
void require_band(double low, double high, const IsosurfaceOptions& options);
template <int dimension, class Real>
Isosurface<dimension> isoband(const Hierarchy<Real>& hierarchy, double low, double high,
                              const Criterion& criterion, const Bounds& bounds,
                              const IsosurfaceOptions& options, const Executor& executor);

template <class Real>
Isolines isolines(const Hierarchy<Real>& hierarchy, std::span<const double> values,
                  const Criterion& criterion, const Bounds& bounds,
                  const IsosurfaceOptions& options, const Executor& executor);

template <class Real>
std::vector<Slice> slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                          const nestgrid::detail::SurfaceTargets<3>& targets,
                          const Criterion& criterion, const Bounds& bounds,
                          IsosurfaceOptions options, const Executor& executor);

template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
            const Executor& executor) {
    return std::move(
        slices(hierarchy, {{&function}}, {}, criterion, bounds, options, executor).front());
}
/// The slice of all data, which needs no bounds.
template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const IsosurfaceOptions& options, const Executor& executor);

/// The least threshold at which a slice has at most max_triangles, counted before vertices are
/// merged at nodes.
template <class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                              const CriterionAt& criterion_at, const Bounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor);

/// The number of triangles of slices and isosurfaces, before vertices are merged at nodes, or
/// nothing where there are more than `most`.
///
/// \throw Cancelled where options.progress ends it
template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const SliceRequest& request,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor);
/// The number of triangles of a shading, or nothing where there are more than `most`.
template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const ShadingOptions& options,
                                             const Executor& executor);

template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                  const Criterion& criterion, const Bounds& bounds);
/// The data on the finest grid, which need no bounds.
template <class Real>
ProbeResult probe(const Hierarchy<Real>& hierarchy, std::span<const Point> points);

}  // namespace nestgrid::engine
