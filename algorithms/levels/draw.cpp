// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/draw.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <nestgrid/error.hpp>

namespace nestgrid {

namespace engine {

template <class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
                      const Bounds& bounds) {
    for (const double isovalue : isovalues) {
        if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
    }
    if (bounds.epoch() != hierarchy.epoch()) {
        throw GridError("the grid has changed since its indicator was computed");
    }
}

void require_saturated(const Criterion& criterion, const Bounds& bounds) {
    if (criterion.insists()) return;
    if (!criterion.saturated()) {
        throw InvalidInput(
            "the criterion is not saturated, so that the surface may have open edges and no bound "
            "holds: saturate it, or insist with Unsaturated{criterion}");
    }
    if (criterion.needs_one_level_a_node() && !bounds.one_level_a_node()) {
        throw InvalidInput(
            "the criterion depends on the level on which a node is created, and the grid creates "
            "some nodes on several levels: use NodeLevels (node_levels.hpp)");
    }
}

template <int dimension, class Real>
std::optional<std::uint64_t> count_simplices(const Hierarchy<Real>& hierarchy, double isovalue,
                                             const Criterion& criterion, const Bounds& bounds,
                                             std::uint64_t most, const IsosurfaceOptions& options,
                                             const Executor& executor) {
    using Drawing = LevelSet<dimension, Real>;
    require_saturated(criterion, bounds);
    IsosurfaceOptions plain;
    plain.cap = options.cap;
    plain.progress = options.progress;
    const Walk<Real> walk(hierarchy, Drawing::needs, bounds.hanging());
    const Level<Real> level(isovalue);
    const LevelSearch<Real> search(walk, std::span(&level, 1), criterion, bounds);
    Surface<dimension> nothing;
    const typename Drawing::Builder builder(nothing, false);
    Drawing drawing(walk, search, std::span(&builder, 1), plain, isosurface_attributes);
    drawing.count_only(most);
    try {
        drawing.run(executor);
    } catch (const OverLimit&) {
        return std::nullopt;
    }
    return drawing.simplices();
}

template <int dimension, class Real>
void draw_levels(const Hierarchy<Real>& hierarchy, std::span<const Level<Real>> levels,
                 std::size_t first_attribute, std::span<const SurfaceBuilder<dimension>> builders,
                 const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
                 const Executor& executor, std::vector<Isosurface<dimension>>& results) {
    using Drawing = LevelSet<dimension, Real>;
    const Walk<Real> walk(hierarchy, Drawing::needs, bounds.hanging());
    const LevelSearch<Real> search(walk, levels, criterion, bounds);
    Drawing drawing(walk, search, builders, options, first_attribute);
    const bool cancelled = run_until_cancelled(drawing, executor);
    drawing.flush();
    for (std::size_t i = 0; i < results.size(); ++i) {
        drawing.report(i, results[i]);
        results[i].cancelled = cancelled;
        if (criterion.insists()) {
            results[i].error_bound = std::numeric_limits<double>::infinity();
        }
    }
}

}  // namespace engine

namespace detail {

namespace {

/// Builders that fill sinks, or the surfaces of the results where there are no sinks.
/// \param chunks memory that the builders fill, one for each surface
template <int dimension>
std::vector<engine::SurfaceBuilder<dimension>> make_builders(
    const SurfaceTargets<dimension>& targets, std::vector<Surface<dimension>>& chunks,
    bool keeps_elements) {
    std::vector<engine::SurfaceBuilder<dimension>> builders;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        if (!targets.soups.empty()) {
            builders.emplace_back(*targets.soups[i], chunks[i]);
        } else if (!targets.meshes.empty()) {
            builders.emplace_back(*targets.meshes[i], chunks[i]);
        } else {
            builders.emplace_back(chunks[i], keeps_elements);
        }
    }
    return builders;
}

}  // namespace

template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
    const SurfaceTargets<dimension>& targets, const Criterion& criterion, const Bounds& bounds,
    const IsosurfaceOptions& options, const Executor& executor) {
    engine::require_drawable(hierarchy, isovalues, bounds);
    engine::require_saturated(criterion, bounds);
    const std::size_t count = isovalues.size();
    const std::size_t sinks = targets.meshes.size() + targets.soups.size();
    if (sinks != 0 && sinks != count) {
        throw InvalidInput(std::to_string(count) + " isovalues need as many sinks, not " +
                           std::to_string(sinks));
    }
    if (!targets.soups.empty() && options.normals) {
        throw InvalidInput("a stream of triangles has no normals");
    }
    std::vector<Surface<dimension>> chunks(count);
    for (Surface<dimension>& chunk : chunks) chunk.elements = hierarchy.make_elements();
    std::vector<Isosurface<dimension>> results(count);
    std::vector<engine::Level<Real>> levels;
    for (const double isovalue : isovalues) levels.emplace_back(isovalue);
    const auto builders = make_builders(targets, chunks, options.elements);
    engine::draw_levels<dimension, Real>(hierarchy, levels, engine::isosurface_attributes, builders,
                                         criterion, bounds, options, executor, results);
    for (std::size_t i = 0; sinks == 0 && i < count; ++i) {
        results[i].surface = std::move(chunks[i]);
    }
    return results;
}

}  // namespace detail

#define NESTGRID_INSTANTIATE(dimension, Real)                                                \
    template std::optional<std::uint64_t> engine::count_simplices<dimension>(                \
        const Hierarchy<Real>&, double, const Criterion&, const Bounds&, std::uint64_t,      \
        const IsosurfaceOptions&, const Executor&);                                          \
    template void engine::draw_levels<dimension>(                                            \
        const Hierarchy<Real>&, std::span<const engine::Level<Real>>, std::size_t,           \
        std::span<const engine::SurfaceBuilder<dimension>>, const Criterion&, const Bounds&, \
        const IsosurfaceOptions&, const Executor&, std::vector<Isosurface<dimension>>&);     \
    template std::vector<Isosurface<dimension>> detail::draw_isosurfaces<dimension>(         \
        const Hierarchy<Real>&, std::span<const double>, const SurfaceTargets<dimension>&,   \
        const Criterion&, const Bounds&, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

template void engine::require_drawable(const Hierarchy<float>&, std::span<const double>,
                                       const Bounds&);
template void engine::require_drawable(const Hierarchy<double>&, std::span<const double>,
                                       const Bounds&);

}  // namespace nestgrid
