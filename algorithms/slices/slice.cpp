// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slice.hpp>

#include <levels/draw.hpp>
#include <walk/hanging_nodes.hpp>

namespace nestgrid::detail {

namespace {

/// What a walk at full resolution needs to know of a grid: the nodes that hang.
template <class Real>
class LeafBounds final : public Bounds {
public:
    explicit LeafBounds(const Hierarchy<Real>& hierarchy)
        : epoch_{hierarchy.epoch()}, hanging_{engine::find_hanging_nodes(hierarchy)} {}
    double offset_bound(NodeKey) const override { return 0; }
    double bound(const Rule&, std::span<const NodeKey>) const override { return 0; }
    const HangingNodes* hanging() const override { return hanging_.empty() ? nullptr : &hanging_; }
    std::uint64_t epoch() const override { return epoch_; }

private:
    std::uint64_t epoch_;
    HangingNodes hanging_;
};

/// Calls draw(levels) with the levels of a request.
template <class Real, class Draw>
auto with_levels(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                 const IsosurfaceOptions& options, Draw&& draw) {
    hierarchy.facts().require_dimension(3);
    const std::size_t functions = request.functions.size();
    const engine::WidenedHierarchy<Real> widened(hierarchy, functions);
    const engine::PositionFunctions placed(request.functions, widened, options.position_bounds);
    engine::Levels<double> levels = engine::isosurface_levels<double>(widened, request.isovalues);
    for (auto& level : levels.levels) level = engine::Level<double>(level.value, functions);
    for (std::size_t i = functions; i-- > 0;) {
        levels.levels.insert(levels.levels.begin(), engine::Level<double>(0, i, 0));
    }
    levels.first_attribute = functions;
    levels.functions = &placed;
    return draw(levels);
}

}  // namespace

template <class Real>
std::vector<Slice> draw_slices(const Hierarchy<Real>& hierarchy, const SliceRequest& request,
                               const SurfaceTargets<3>& targets, const Criterion& criterion,
                               const Bounds& bounds, IsosurfaceOptions options,
                               const Executor& executor) {
    options.at_nodes = targets.soups.empty();
    return with_levels(hierarchy, request, options, [&](const engine::Levels<double>& levels) {
        return engine::draw_levels<3>(levels, targets, criterion, bounds, options, executor);
    });
}

template <class Real>
Slice draw_slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                 const HierarchicalIndicator* indicator, const IsosurfaceOptions& options,
                 const Executor& executor) {
    const SliceRequest request{{&function}};
    hierarchy.facts().require_dimension(3);
    if (indicator == nullptr && options.threshold == 0 && options.max_triangles == 0) {
        const LeafBounds<Real> leaves(hierarchy);
        return std::move(
            draw_slices(hierarchy, request, {}, Exact{}, leaves, options, executor).front());
    }
    std::optional<HierarchicalIndicator> own;
    if (indicator == nullptr) indicator = &own.emplace(hierarchy, LeafErrors{}, executor);
    return with_levels(hierarchy, request, options, [&](const engine::Levels<double>& levels) {
        const Threshold s = engine::criterion_for<3>(levels, *indicator, options, executor);
        IsosurfaceOptions merged = options;
        merged.at_nodes = true;
        return std::move(
            engine::draw_levels<3>(levels, {}, s, *indicator, merged, executor).front());
    });
}

template <class Real>
TriangleBudget find_slice_threshold(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                                    const MakeCriterion& criterion_at, const SearchBounds& bounds,
                                    std::uint64_t max_triangles, const IsosurfaceOptions& options,
                                    const Executor& executor) {
    return with_levels(hierarchy, {{&function}}, options,
                       [&](const engine::Levels<double>& levels) {
                           return engine::find_threshold<3>(levels, criterion_at, bounds,
                                                            max_triangles, options, executor);
                       });
}

#define NESTGRID_INSTANTIATE(Real)                                                               \
    template std::vector<Slice> draw_slices(const Hierarchy<Real>&, const SliceRequest&,         \
                                            const SurfaceTargets<3>&, const Criterion&,          \
                                            const Bounds&, IsosurfaceOptions, const Executor&);  \
    template Slice draw_slice(const Hierarchy<Real>&, const LevelFunction&,                      \
                              const HierarchicalIndicator*, const IsosurfaceOptions&,            \
                              const Executor&);                                                  \
    template TriangleBudget find_slice_threshold(                                                \
        const Hierarchy<Real>&, const LevelFunction&, const MakeCriterion&, const SearchBounds&, \
        std::uint64_t, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(float)
NESTGRID_INSTANTIATE(double)
#undef NESTGRID_INSTANTIATE

}  // namespace nestgrid::detail
