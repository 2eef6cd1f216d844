// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurfaces.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

namespace nestgrid {

template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const Criterion& criterion, const Bounds& bounds,
                                 const IsosurfaceOptions& options, const Executor& executor) {
    return std::move(isosurfaces<dimension>(hierarchy, std::span<const double>(&isovalue, 1),
                                            criterion, bounds, options, executor)
                         .front());
}

template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const HierarchicalIndicator& indicator,
                                 const IsosurfaceOptions& options, const Executor& executor) {
    const Threshold s = criterion_for<dimension>(hierarchy, isovalue, indicator, options, executor);
    return isosurface<dimension>(hierarchy, isovalue, s, indicator, options, executor);
}

template <int dimension, class Real>
Isosurface<dimension> isosurface(const Hierarchy<Real>& hierarchy, double isovalue,
                                 const IsosurfaceOptions& options, const Executor& executor) {
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return isosurface<dimension>(hierarchy, isovalue, indicator, options, executor);
}

#define NESTGRID_INSTANTIATE(dimension, Real)                                                      \
    template Isosurface<dimension> isosurface<dimension>(                                          \
        const Hierarchy<Real>&, double, const Criterion&, const Bounds&, const IsosurfaceOptions&, \
        const Executor&);                                                                          \
    template Isosurface<dimension> isosurface<dimension>(                                          \
        const Hierarchy<Real>&, double, const HierarchicalIndicator&, const IsosurfaceOptions&,    \
        const Executor&);                                                                          \
    template Isosurface<dimension> isosurface<dimension>(                                          \
        const Hierarchy<Real>&, double, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
