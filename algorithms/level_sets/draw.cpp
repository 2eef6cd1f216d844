// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <level_sets/draw.hpp>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <nestgrid/error.hpp>
#include <projection/by_criterion.hpp>
#include <projection/made_for_ranks.hpp>
#include <ranks/agreement.hpp>

namespace nestgrid {

namespace engine {

template <class Real>
void set_isovalues(Levels<Real>& levels, std::span<const double> isovalues) {
    levels.levels.clear();
    for (const double isovalue : isovalues) {
        if (!std::isfinite(isovalue)) throw InvalidInput("the isovalue is not a finite number");
        levels.levels.emplace_back(isovalue);
    }
}

template <class Real>
Levels<Real> isosurface_levels(const Hierarchy<Real>& hierarchy,
                               std::span<const double> isovalues) {
    Levels<Real> levels{&hierarchy, {}};
    set_isovalues(levels, isovalues);
    return levels;
}

template <int dimension>
void require_options(const IsosurfaceOptions& options) {
    if (!options.at_nodes) return;
    if (dimension != 3) throw InvalidInput("vertices at nodes need a grid of dimension 3");
    if (options.reference) {
        throw InvalidInput("a surface with vertices at nodes has no reference coordinates");
    }
}

namespace {

/// Tells functions of position apart by their values at one point.
template <class Real>
std::string of_functions(const Levels<Real>& levels) {
    const SharedNodes* const shared = levels.hierarchy->facts().shared;
    if (levels.functions == nullptr || shared == nullptr) return {};
    std::string text;
    for (std::size_t i = 0; i < levels.functions->count(); ++i) {
        text += "a slice by a function with the value " +
                all_digits(levels.functions->template at<double>(i, shared->corner())) + " at " +
                text_of(shared->corner()) + ", ";
    }
    return text;
}

}  // namespace

template <class Real>
std::string asked_for(const Levels<Real>& levels, const Criterion& criterion,
                      const IsosurfaceOptions& options) {
    return of_functions(levels) + asked_for<Real>(levels.levels, criterion, options);
}

template <int dimension, class Real>
void require_drawable(const Hierarchy<Real>& hierarchy, const Criterion& criterion,
                      const Bounds& bounds, const IsosurfaceOptions& options) {
    if (hierarchy.facts().shared != nullptr) {
        require_same_state(hierarchy);
        require_drawn_on_ranks(criterion, bounds, options, hierarchy.offers(Feature::gradients));
    }
    require_sound(hierarchy, criterion, bounds);
    require_options<dimension>(options);
}

template <int dimension, class Real>
std::optional<std::uint64_t> count_simplices(const Levels<Real>& levels, const Criterion& criterion,
                                             const Bounds& bounds, std::uint64_t most,
                                             const IsosurfaceOptions& options,
                                             const Executor& executor) {
    using Drawing = LevelSet<dimension, Real>;
    const SharedNodes* const shared = levels.hierarchy->facts().shared;
    IsosurfaceOptions plain;
    plain.cap = options.cap;
    plain.progress = options.progress;
    std::optional<Walk<Real>> walk;
    const auto asked = [&] {
        return "at most " + std::to_string(most) + " simplices, " +
               asked_for(levels, criterion, plain);
    };
    together(shared, asked, [&] {
        require_drawable<dimension>(*levels.hierarchy, criterion, bounds, plain);
        walk.emplace(*levels.hierarchy, Drawing::needs, bounds.hanging(), levels.functions);
    });
    const LevelSearch<Real> search(*walk, levels.levels, criterion, bounds);
    Surface<dimension> nothing;
    const std::vector<typename Drawing::Builder> builders(levels.levels.size(), {nothing, false});
    Drawing drawing(*walk, search, builders, plain, levels.first_attribute);
    return count_within<Real>(drawing, most, executor, shared);
}

namespace {

template <int dimension>
using Targets = nestgrid::detail::SurfaceTargets<dimension>;

template <int dimension>
void require_targets(const Targets<dimension>& targets, std::size_t levels,
                     const IsosurfaceOptions& options) {
    const std::size_t sinks = targets.meshes.size() + targets.soups.size();
    if (sinks != 0 && sinks != levels) {
        throw InvalidInput(std::to_string(levels) + " surfaces need as many sinks, not " +
                           std::to_string(sinks));
    }
    if (targets.soups.empty()) return;
    if (options.normals) throw InvalidInput("a stream of triangles has no normals");
    if (options.at_nodes) throw InvalidInput("a stream of triangles has no vertices at nodes");
}

/// Builders that fill sinks, or surfaces where there are no sinks, or where vertices are merged
/// before a sink takes the surface.
/// \param chunks memory that the builders fill, one for each surface
template <int dimension>
std::vector<SurfaceBuilder<dimension>> make_builders(const Targets<dimension>& targets,
                                                     std::vector<Surface<dimension>>& chunks,
                                                     const IsosurfaceOptions& options) {
    std::vector<SurfaceBuilder<dimension>> builders;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        if (!targets.soups.empty()) {
            builders.emplace_back(*targets.soups[i], chunks[i]);
        } else if (targets.meshes.empty()) {
            builders.emplace_back(chunks[i], options.elements);
        } else if (options.at_nodes) {
            builders.emplace_back(chunks[i], targets.meshes[i]->keeps_elements());
        } else {
            builders.emplace_back(*targets.meshes[i], chunks[i]);
        }
    }
    return builders;
}

/// Moves the surfaces that were drawn into chunks to where they belong.
template <int dimension>
void hand_over(const Targets<dimension>& targets, std::vector<Surface<dimension>>& chunks,
               const IsosurfaceOptions& options, std::vector<Isosurface<dimension>>& results) {
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        if (targets.meshes.empty() && targets.soups.empty()) {
            results[i].surface = std::move(chunks[i]);
        } else if (options.at_nodes) {
            targets.meshes[i]->take(chunks[i]);
            if (options.normals) targets.meshes[i]->set_normals(chunks[i].normals);
        }
    }
}

}  // namespace

template <int dimension, class Real>
std::vector<Isosurface<dimension>> draw_levels(const Levels<Real>& levels,
                                               const Targets<dimension>& targets,
                                               const Criterion& criterion, const Bounds& bounds,
                                               const IsosurfaceOptions& options,
                                               const Executor& executor) {
    using Drawing = LevelSet<dimension, Real>;
    const std::size_t count = levels.levels.size();
    const SharedNodes* const shared = levels.hierarchy->facts().shared;
    std::optional<Walk<Real>> walk;
    together(
        shared, [&] { return asked_for(levels, criterion, options); },
        [&] {
            require_drawable<dimension>(*levels.hierarchy, criterion, bounds, options);
            require_targets(targets, count, options);
            walk.emplace(*levels.hierarchy, Drawing::needs, bounds.hanging(), levels.functions);
        });
    std::vector<Surface<dimension>> chunks(count);
    for (Surface<dimension>& chunk : chunks) chunk.elements = levels.hierarchy->make_elements();
    const auto builders = make_builders(targets, chunks, options);
    const LevelSearch<Real> search(*walk, levels.levels, criterion, bounds);
    Drawing drawing(*walk, search, builders, options, levels.first_attribute);
    drawing.draw_once();
    const bool cancelled = run_until_cancelled<Real>(drawing, executor, shared);
    std::vector<Isosurface<dimension>> results(count);
    for (std::size_t i = 0; i < count; ++i) {
        drawing.report(i, results[i]);
        results[i].cancelled = cancelled;
        if (criterion.insists()) {
            results[i].error_bound = results[i].range_bound;
            if (options.position_bounds != nullptr) {
                results[i].position_bound = std::numeric_limits<double>::infinity();
            }
        }
    }
    hand_over(targets, chunks, options, results);
    return results;
}

template <int dimension, class Real>
std::vector<Isosurface<dimension>> isosurfaces(const Hierarchy<Real>& hierarchy,
                                               std::span<const double> isovalues,
                                               const Targets<dimension>& targets,
                                               const Criterion& criterion, const Bounds& bounds,
                                               const IsosurfaceOptions& options,
                                               const Executor& executor) {
    Levels<Real> levels{&hierarchy, {}};
    together(hierarchy.facts().shared, "isosurfaces", [&] {
        hierarchy.facts().require_dimension(dimension);
        levels = isosurface_levels(hierarchy, isovalues);
    });
    return draw_levels<dimension>(levels, targets, criterion, bounds, options, executor);
}

}  // namespace engine

#define NESTGRID_INSTANTIATE(dimension, Real)                                                      \
    template void engine::require_drawable<dimension>(const Hierarchy<Real>&, const Criterion&,    \
                                                      const Bounds&, const IsosurfaceOptions&);    \
    template std::optional<std::uint64_t> engine::count_simplices<dimension>(                      \
        const engine::Levels<Real>&, const Criterion&, const Bounds&, std::uint64_t,               \
        const IsosurfaceOptions&, const Executor&);                                                \
    template std::vector<Isosurface<dimension>> engine::draw_levels<dimension>(                    \
        const engine::Levels<Real>&, const detail::SurfaceTargets<dimension>&, const Criterion&,   \
        const Bounds&, const IsosurfaceOptions&, const Executor&);                                 \
    template std::vector<Isosurface<dimension>> engine::isosurfaces<dimension>(                    \
        const Hierarchy<Real>&, std::span<const double>, const detail::SurfaceTargets<dimension>&, \
        const Criterion&, const Bounds&, const IsosurfaceOptions&, const Executor&);
NESTGRID_INSTANTIATE(2, float)
NESTGRID_INSTANTIATE(2, double)
NESTGRID_INSTANTIATE(3, float)
NESTGRID_INSTANTIATE(3, double)
#undef NESTGRID_INSTANTIATE

template void engine::require_options<2>(const IsosurfaceOptions&);
template void engine::require_options<3>(const IsosurfaceOptions&);
template std::string engine::asked_for(const engine::Levels<float>&, const Criterion&,
                                       const IsosurfaceOptions&);
template std::string engine::asked_for(const engine::Levels<double>&, const Criterion&,
                                       const IsosurfaceOptions&);
template void engine::set_isovalues(engine::Levels<float>&, std::span<const double>);
template void engine::set_isovalues(engine::Levels<double>&, std::span<const double>);
template engine::Levels<float> engine::isosurface_levels(const Hierarchy<float>&,
                                                         std::span<const double>);
template engine::Levels<double> engine::isosurface_levels(const Hierarchy<double>&,
                                                          std::span<const double>);

}  // namespace nestgrid
