// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/draw.hpp>
#include <nestgrid/error.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid::engine {

template <int dimension, class Real>
TriangleBudget find_threshold(const Levels<Real>& levels, const CriterionAt& criterion_at,
                              const Bounds& bounds, std::uint64_t max_triangles,
                              const IsosurfaceOptions& options, const Executor& executor) {
    const auto count = [&](double threshold, std::uint64_t most) {
        std::optional<AnyCriterion> criterion;
        together(levels.hierarchy->facts().shared, "a number of triangles",
                 [&] { criterion = criterion_at(threshold); });
        return count_simplices<dimension>(levels, *criterion, bounds, most, options, executor);
    };
    return least_threshold(count, bounds.greatest() - bounds.least(), max_triangles);
}

template <int dimension, class Real>
TriangleBudget find_threshold(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
                              const CriterionAt& criterion_at, const Bounds& bounds,
                              std::uint64_t max_triangles, const IsosurfaceOptions& options,
                              const Executor& executor) {
    Levels<Real> levels{&hierarchy, {}};
    together(hierarchy.facts().shared, "a number of triangles",
             [&] { levels = isosurface_levels(hierarchy, isovalues); });
    return find_threshold<dimension>(levels, criterion_at, bounds, max_triangles, options,
                                     executor);
}

template <int dimension, class Real>
Threshold criterion_for(const Levels<Real>& levels, const HierarchicalIndicator& indicator,
                        const Projection& projection, const IsosurfaceOptions& options,
                        const Executor& executor) {
    together(levels.hierarchy->facts().shared, "isosurfaces", [&] { projection.check(); });
    if (projection.max_triangles == 0) return {&indicator, projection.least_threshold()};
    const auto everywhere = [&](double threshold) { return Threshold(&indicator, threshold); };
    const TriangleBudget best = find_threshold<dimension>(
        levels, everywhere, indicator, projection.max_triangles, options, executor);
    return {&indicator, best.threshold};
}

#define NESTGRID_INSTANTIATE(dimension, Real)                                                      \
    template TriangleBudget find_threshold<dimension>(const Levels<Real>&, const CriterionAt&,     \
                                                      const Bounds&, std::uint64_t,                \
                                                      const IsosurfaceOptions&, const Executor&);  \
    template TriangleBudget find_threshold<dimension>(                                             \
        const Hierarchy<Real>&, std::span<const double>, const CriterionAt&, const Bounds&,        \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);                                 \
    template Threshold criterion_for<dimension>(const Levels<Real>&, const HierarchicalIndicator&, \
                                                const Projection&, const IsosurfaceOptions&,       \
                                                const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::engine
