// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <levels/draw.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <levels/isosurface_visitor.hpp>
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
    using Visitor = IsosurfaceVisitor<dimension, Real, true>;
    require_saturated(criterion, bounds);
    IsosurfaceOptions plain;
    plain.cap = options.cap;
    plain.progress = options.progress;
    const Walk<Real> walk(hierarchy, Visitor::needs, bounds.hanging());
    Surface<dimension> nothing;
    Visitor visitor(walk, std::span<const double>(&isovalue, 1),
                    {typename Visitor::Builder(nothing, false)}, criterion, bounds, plain);
    visitor.count_only(most);
    try {
        visitor.run(executor);
    } catch (const OverLimit&) {
        return std::nullopt;
    }
    return visitor.simplices();
}

namespace {

/// \return whether options.progress ended it
template <class Visitor>
bool run_visitor(Visitor& visitor, const Executor& executor) {
    try {
        visitor.run(executor);
        return false;
    } catch (const Cancelled&) {
        return true;
    }
}

/// Draws into builders and reports what is known beside the surfaces.
template <int dimension, class Real, bool indexed>
void draw(const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
          std::vector<typename IsosurfaceVisitor<dimension, Real, indexed>::Builder> builders,
          const Criterion& criterion, const Bounds& bounds, const IsosurfaceOptions& options,
          const Executor& executor, std::vector<Isosurface<dimension>>& results) {
    using Visitor = IsosurfaceVisitor<dimension, Real, indexed>;
    const Walk<Real> walk(hierarchy, Visitor::needs, bounds.hanging());
    Visitor visitor(walk, isovalues, std::move(builders), criterion, bounds, options);
    const bool cancelled = run_visitor(visitor, executor);
    visitor.flush();
    for (std::size_t i = 0; i < results.size(); ++i) {
        visitor.report(i, results[i]);
        results[i].cancelled = cancelled;
        if (criterion.insists()) {
            results[i].error_bound = std::numeric_limits<double>::infinity();
        }
    }
}

}  // namespace

}  // namespace engine

namespace detail {

template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_isosurfaces(
    const Hierarchy<Real>& hierarchy, std::span<const double> isovalues,
    const SurfaceTargets<dimension>& targets, const Criterion& criterion, const Bounds& bounds,
    const IsosurfaceOptions& options, const Executor& executor) {
    using engine::SoupBuilder;
    using engine::SurfaceBuilder;
    engine::require_drawable(hierarchy, isovalues, bounds);
    engine::require_saturated(criterion, bounds);
    const std::size_t count = isovalues.size();
    const std::size_t sinks = targets.meshes.size() + targets.soups.size();
    if (sinks != 0 && sinks != count) {
        throw InvalidInput(std::to_string(count) + " isovalues need as many sinks, not " +
                           std::to_string(sinks));
    }
    std::vector<Isosurface<dimension>> results(count);
    if (!targets.soups.empty()) {
        if (options.normals) throw InvalidInput("a stream of triangles has no normals");
        std::vector<Soup<dimension>> chunks(count);
        std::vector<SoupBuilder<dimension>> builders;
        for (std::size_t i = 0; i < count; ++i) {
            chunks[i].elements = hierarchy.make_elements();
            builders.emplace_back(*targets.soups[i], chunks[i]);
        }
        engine::draw<dimension, Real, false>(hierarchy, isovalues, std::move(builders), criterion,
                                             bounds, options, executor, results);
        return results;
    }
    std::vector<Surface<dimension>> chunks(count);
    std::vector<SurfaceBuilder<dimension>> builders;
    for (std::size_t i = 0; i < count; ++i) {
        chunks[i].elements = hierarchy.make_elements();
        if (targets.meshes.empty()) {
            builders.emplace_back(chunks[i], options.elements);
        } else {
            builders.emplace_back(*targets.meshes[i], chunks[i]);
        }
    }
    engine::draw<dimension, Real, true>(hierarchy, isovalues, std::move(builders), criterion,
                                        bounds, options, executor, results);
    for (std::size_t i = 0; targets.meshes.empty() && i < count; ++i) {
        results[i].surface = std::move(chunks[i]);
    }
    return results;
}

}  // namespace detail

#define NESTGRID_INSTANTIATE(dimension, Real)                                              \
    template std::optional<std::uint64_t> engine::count_simplices<dimension>(              \
        const Hierarchy<Real>&, double, const Criterion&, const Bounds&, std::uint64_t,    \
        const IsosurfaceOptions&, const Executor&);                                        \
    template std::vector<Isosurface<dimension>> detail::draw_isosurfaces<dimension>(       \
        const Hierarchy<Real>&, std::span<const double>, const SurfaceTargets<dimension>&, \
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
