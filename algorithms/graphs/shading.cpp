// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/shading.hpp>

#include <graphs/triangulate.hpp>

namespace nestgrid {

template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const Criterion& criterion, const Bounds& bounds,
                const ShadingOptions& options, const Executor& executor) {
    return engine::triangulate(hierarchy, 0, criterion, bounds, options, executor);
}

template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const HierarchicalIndicator& indicator,
                const ShadingOptions& options, const Executor& executor) {
    return engine::triangulate(hierarchy, 0, indicator, options, executor);
}

template <class Real>
Shading shading(const Hierarchy<Real>& hierarchy, const ShadingOptions& options,
                const Executor& executor) {
    return engine::triangulate(hierarchy, 0, options, executor);
}

#define NESTGRID_INSTANTIATE(Real)                                                    \
    template Shading shading(const Hierarchy<Real>&, const Criterion&, const Bounds&, \
                             const ShadingOptions&, const Executor&);                 \
    template Shading shading(const Hierarchy<Real>&, const HierarchicalIndicator&,    \
                             const ShadingOptions&, const Executor&);                 \
    template Shading shading(const Hierarchy<Real>&, const ShadingOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
