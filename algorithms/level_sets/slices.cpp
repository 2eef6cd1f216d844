// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/leaf_bounds.hpp>
#include <level_sets/slice_levels.hpp>
#include <projection/by_criterion.hpp>

namespace nestgrid::engine {

template <class Real>
std::vector<Slice> slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                          const nestgrid::detail::SurfaceTargets<3>& targets,
                          const Criterion& criterion, const Bounds& bounds,
                          IsosurfaceOptions options, const Executor& executor) {
    options.at_nodes = targets.soups.empty();
    return with_levels(hierarchy, request, options, [&](const Levels<double>& levels) {
        return draw_levels<3>(levels, targets, criterion, bounds, options, executor);
    });
}

template <class Real>
Slice slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
            const IsosurfaceOptions& options, const Executor& executor) {
    hierarchy.facts().require_dimension(3);
    const LeafBounds leaves(hierarchy);
    return slice(hierarchy, function, Exact{}, leaves, options, executor);
}

template <class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                              const CriterionAt& criterion_at, const Bounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor) {
    hierarchy.facts().require_dimension(3);
    return with_levels(hierarchy, {{&function}}, options, [&](const Levels<double>& levels) {
        return find_threshold<3>(levels, criterion_at, bounds, max_triangles, options, executor);
    });
}

template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const SliceRequest& request,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor) {
    hierarchy.facts().require_dimension(3);
    const auto count = [&](const auto& levels) {
        return count_simplices<3>(levels, criterion, bounds, most, options, executor);
    };
    if (!request.functions.empty()) return with_levels(hierarchy, request, options, count);
    Levels<Real> levels{&hierarchy, {}};
    together(hierarchy.facts().shared, "a number of triangles", [&] {
        levels = isosurface_levels(hierarchy, std::span<const double>(request.isovalues));
    });
    return count(levels);
}

#define NESTGRID_INSTANTIATE(Real)                                                               \
    template std::vector<Slice> slices(                                                          \
        const Hierarchy<Real>&, const SliceRequest&, const nestgrid::detail::SurfaceTargets<3>&, \
        const Criterion&, const Bounds&, IsosurfaceOptions, const Executor&);                    \
    template Slice slice(const Hierarchy<Real>&, const LevelFunction&, const IsosurfaceOptions&, \
                         const Executor&);                                                       \
    template std::optional<std::uint64_t> count_triangles(                                       \
        const Hierarchy<Real>&, const SliceRequest&, const Criterion&, const Bounds&,            \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);                               \
    template TriangleBudget find_threshold(const Hierarchy<Real>&, const LevelFunction&,         \
                                           const CriterionAt&, const Bounds&, std::uint64_t,     \
                                           const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
