// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/height_field.hpp>

#include <graphs/triangulate.hpp>

namespace nestgrid {

template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const Criterion& criterion,
                     const Bounds& bounds, const ShadingOptions& options,
                     const Executor& executor) {
    return engine::triangulate(hierarchy, scale, criterion, bounds, options, executor);
}

template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale,
                     const HierarchicalIndicator& indicator, const ShadingOptions& options,
                     const Executor& executor) {
    return engine::triangulate(hierarchy, scale, indicator, options, executor);
}

template <class Real>
Shading height_field(const Hierarchy<Real>& hierarchy, double scale, const ShadingOptions& options,
                     const Executor& executor) {
    return engine::triangulate(hierarchy, scale, options, executor);
}

#define NESTGRID_INSTANTIATE(Real)                                                                 \
    template Shading height_field(const Hierarchy<Real>&, double, const Criterion&, const Bounds&, \
                                  const ShadingOptions&, const Executor&);                         \
    template Shading height_field(const Hierarchy<Real>&, double, const HierarchicalIndicator&,    \
                                  const ShadingOptions&, const Executor&);                         \
    template Shading height_field(const Hierarchy<Real>&, double, const ShadingOptions&,           \
                                  const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
