// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slices.hpp>

#include <slices/leaf_bounds.hpp>
#include <slices/slice_levels.hpp>

namespace nestgrid {

template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
            const Executor& executor) {
    return std::move(
        slices(hierarchy, {{&function}}, criterion, bounds, options, executor).front());
}

template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const HierarchicalIndicator& indicator, const IsosurfaceOptions& options,
            const Executor& executor) {
    const auto draw = [&](const engine::Levels<double>& levels) {
        const Threshold s = engine::criterion_for<3>(levels, indicator, options, executor);
        IsosurfaceOptions merged = options;
        merged.at_nodes = true;
        return std::move(
            engine::draw_levels<3>(levels, {}, s, indicator, merged, executor).front());
    };
    return engine::with_levels(hierarchy, {{&function}}, options, draw);
}

template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const IsosurfaceOptions& options, const Executor& executor) {
    hierarchy.facts().require_dimension(3);
    if (options.threshold == 0 && options.max_triangles == 0) {
        const engine::LeafBounds leaves(hierarchy);
        return slice(hierarchy, function, Exact{}, leaves, options, executor);
    }
    const HierarchicalIndicator indicator(hierarchy, LeafErrors{}, executor);
    return slice(hierarchy, function, indicator, options, executor);
}

#define NESTGRID_INSTANTIATE(Real)                                                                 \
    template Slice slice(const Hierarchy<Real>&, const LevelFunction&, const Criterion&,           \
                         const Bounds&, const IsosurfaceOptions&, const Executor&);                \
    template Slice slice(const Hierarchy<Real>&, const LevelFunction&,                             \
                         const HierarchicalIndicator&, const IsosurfaceOptions&, const Executor&); \
    template Slice slice(const Hierarchy<Real>&, const LevelFunction&, const IsosurfaceOptions&,   \
                         const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid
