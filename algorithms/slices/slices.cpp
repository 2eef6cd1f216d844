// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slices.hpp>

#include <slices/slice_levels.hpp>

namespace nestgrid::detail {

template <class Real>
std::vector<Slice> draw_slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                               const SurfaceTargets<3>& targets, const Criterion& criterion,
                               const Bounds& bounds, IsosurfaceOptions options,
                               const Executor& executor) {
    options.at_nodes = targets.soups.empty();
    return engine::with_levels(
        hierarchy, request, options, [&](const engine::Levels<double>& levels) {
            return engine::draw_levels<3>(levels, targets, criterion, bounds, options, executor);
        });
}

template <class Real>
TriangleBudget find_slice_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                                    const MakeCriterion& criterion_at, const SearchBounds& bounds,
                                    std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                    const Executor& executor) {
    return engine::with_levels(
        hierarchy, {{&function}}, options, [&](const engine::Levels<double>& levels) {
            return engine::find_threshold<3>(levels, criterion_at, bounds, max_triangles, options,
                                             executor);
        });
}

}  // namespace nestgrid::detail

namespace nestgrid {

template <class Real>
std::optional<std::uint64_t> count_triangles(const Hierarchy<Real>& hierarchy,
                                             const SliceRequest& request,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor) {
    hierarchy.facts().require_dimension(3);
    const auto count = [&](const auto& levels) {
        return engine::count_simplices<3>(levels, criterion, bounds, most, options, executor);
    };
    try {
        if (!request.functions.empty()) {
            return engine::with_levels(hierarchy, request, options, count);
        }
        engine::Levels<Real> levels{&hierarchy, {}};
        engine::together(hierarchy.facts().shared, "a number of triangles", [&] {
            levels =
                engine::isosurface_levels(hierarchy, std::span<const double>(request.isovalues));
        });
        return count(levels);
    } catch (const engine::Cancelled&) {
        return std::nullopt;
    }
}

template std::optional<std::uint64_t> count_triangles(const Hierarchy<float>&, const SliceRequest&,
                                                      const Criterion&, const Bounds&,
                                                      std::uint64_t, const IsosurfaceOptions&,
                                                      const Executor&);
template std::optional<std::uint64_t> count_triangles(const Hierarchy<double>&, const SliceRequest&,
                                                      const Criterion&, const Bounds&,
                                                      std::uint64_t, const IsosurfaceOptions&,
                                                      const Executor&);

}  // namespace nestgrid

namespace nestgrid::detail {

#define NESTGRID_INSTANTIATE(Real)                                                               \
    template std::vector<Slice> draw_slices(const Hierarchy<Real>&, const SliceRequest&,         \
                                            const SurfaceTargets<3>&, const Criterion&,          \
                                            const Bounds&, IsosurfaceOptions, const Executor&);  \
    template TriangleBudget find_slice_threshold(                                                \
        const Hierarchy<Real>&, const LevelFunction&, const MakeCriterion&, const SearchBounds&, \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::detail
