// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>

#include <collapses/collapse_budget.hpp>
#include <height_fields/triangulate.hpp>
#include <nestgrid/algorithms/boundary_surface.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/count_triangles.hpp>
#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/polynomial_values.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <projection/by_criterion.hpp>
#include <projection/drawn_within.hpp>
#include <walk/frontier.hpp>

namespace nestgrid {

namespace {

/// The part of an error that colours have before edges are collapsed.
constexpr double colour_start = 0.5;

/// Collapses edges while the colours of a surface keep an error.
template <class Real, class Result>
void collapse_colours_of(Projected<Result>& drawn, const Hierarchy<Real>& hierarchy,
                         const Bounds& bounds, const ColourCollapseOptions& options,
                         double& surface_error, const Executor& executor) {
    drawn.collapsed = collapse_colours(drawn.surface, hierarchy, bounds, options, executor);
    drawn.collapsed->hand_to(drawn, surface_error);
}

/// Draws within the threshold that the projection gives, or the least one with its number of
/// triangles.
/// \param within within(threshold, drawn, work) draws, and collapses where the projection says so;
///        it sets `drawn` to the triangles that there were before
/// \param find finds the threshold where nothing is collapsed
template <class Within, class Find>
auto draw_within(const Criteria& criteria, const Work& work, const Within& within,
                 const Find& find) {
    const Projection& projection = criteria.projection();
    const Work silent{.executor = work.executor};
    const TriangleBudget search = engine::threshold_of(projection, work, [&] {
        if (!projection.collapse) return find();
        const engine::TryCollapse attempt =
            [&](double error) -> std::optional<engine::CollapseTrial> {
            engine::CollapseTrial trial;
            const auto drawn = within(error, trial.drawn, silent);
            if (drawn.cancelled) return std::nullopt;
            trial.left = drawn.surface.simplices.size();
            return trial;
        };
        const double range = criteria.bounds().greatest() - criteria.bounds().least();
        return engine::find_collapse_error(attempt, range, projection.max_triangles);
    });
    std::uint64_t begun = 0;
    auto drawn = within(search.threshold, begun, work);
    drawn.search = search;
    return drawn;
}

/// Splits triangles of a drawing of polynomials for their colours where the projection asks for it.
template <class Result>
void refine_asked(Projected<Result>& drawn, const Prerolls& prerolls, const Projection& projection,
                  const Work& work) {
    if (projection.colour_tolerance == 0 || drawn.cancelled) return;
    refine_colours(drawn.surface, prerolls, projection.colour_tolerance, projection, work);
}

template <class Real>
Projected<Slice> draw_slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                            const Criteria& criteria, const IsosurfaceOptions& options,
                            const Work& work) {
    const Executor& executor = work.executor;
    const Projection& projection = criteria.projection();
    const Bounds& bounds = criteria.bounds();
    const auto within = [&](double error, std::uint64_t& begun, const Work& here) {
        here.begin("drawing");
        const bool collapses = projection.collapse && error > 0;
        const double first = collapses ? colour_start * error : error;
        // Only a slice of all data is as near to its function as the grid allows.
        const bool moves = collapses && projection.slice_distance > 0;
        const AnyCriterion criterion = moves ? AnyCriterion(Exact{}) : criteria.at(first);
        Projected<Slice> drawn{
            engine::slice(hierarchy, function, criterion, bounds, options, executor)};
        begun = drawn.surface.simplices.size();
        if (drawn.cancelled) return drawn;
        const double tolerance = collapses ? first : projection.colour_tolerance;
        if (tolerance > 0) {
            refine_colours(drawn.surface, hierarchy, tolerance, under(criterion, bounds));
        }
        if (!collapses) return drawn;
        here.begin("collapsing");
        ColourCollapseOptions kept{.errors = {error}};
        Surface<3> whole;
        if (moves) {
            whole = drawn.surface;
            kept.nearness.emplace(Nearness{whole, projection.slice_distance});
        }
        collapse_colours_of(drawn, hierarchy, bounds, kept, drawn.surface_error, executor);
        return drawn;
    };
    return draw_within(criteria, work, within, [&] {
        return engine::find_threshold(hierarchy, function, engine::criteria_at(criteria), bounds,
                                      projection.max_triangles, options, executor);
    });
}

/// \param scale nothing: in the plane
template <class Real>
Projected<Shading> draw_shading(const Hierarchy<Real>& hierarchy, std::optional<double> scale,
                                const Criteria& criteria, const ShadingOptions& options,
                                const Work& work) {
    const Executor& executor = work.executor;
    const Projection& projection = criteria.projection();
    const Bounds& bounds = criteria.bounds();
    const auto within = [&](double error, std::uint64_t& begun, const Work& here) {
        here.begin("drawing");
        const bool collapses = projection.collapse && error > 0;
        const double first = collapses ? colour_start * error : error;
        ShadingOptions flat = options;
        if (collapses) flat.flatness = std::min(flat.flatness, first);
        const AnyCriterion s = criteria.at(first);
        Projected<Shading> drawn{
            engine::triangulate(hierarchy, scale.value_or(0), s, bounds, flat, executor)};
        begun = drawn.surface.simplices.size();
        if (drawn.cancelled) return drawn;
        if (projection.colour_tolerance > 0) {
            refine_colours(drawn.surface, hierarchy, projection.colour_tolerance, under(s, bounds));
        }
        if (!collapses) return drawn;
        here.begin("collapsing");
        double no_surface_error = 0;
        collapse_colours_of(drawn, hierarchy, bounds,
                            {.errors = {error}, .scale = scale.value_or(0)}, no_surface_error,
                            executor);
        return drawn;
    };
    return draw_within(criteria, work, within, [&] {
        const auto count = [&](double threshold, std::uint64_t most) {
            return engine::count_triangles(hierarchy, criteria.at(threshold), bounds, most, options,
                                           executor);
        };
        return least_threshold(count, bounds.greatest() - bounds.least(), projection.max_triangles);
    });
}

/// Collapses edges of a drawing of polynomials while its colours keep an error.
template <class Result>
auto collapsing_colours(double scale, const Work& work) {
    return [scale, &work](Projected<Result>& drawn, const VirtualRefinement& fine, double error) {
        double no_surface_error = 0;
        double* surface_error = &no_surface_error;
        if constexpr (requires { drawn.surface_error; }) surface_error = &drawn.surface_error;
        collapse_colours_of<double>(drawn, fine, fine.bounds(), {.errors = {error}, .scale = scale},
                                    *surface_error, work.executor);
    };
}

Projected<Shading> shaded(const Prerolls& prerolls, std::optional<double> scale,
                          const Projection& projection, const ShadingOptions& options,
                          const Work& work) {
    engine::check_first(prerolls, projection, work, "shadings", [&] {
        engine::refuse_distance(projection);
        engine::refuse_slice_distance(projection);
        if (scale) engine::refuse_tolerance(projection);
    });
    const auto within = [&](const VirtualRefinement& fine) {
        return engine::triangulate(fine, scale.value_or(0), fine.criterion(), fine.bounds(),
                                   options, work.executor);
    };
    const auto count = [&](const VirtualRefinement& fine, std::uint64_t most) {
        return engine::count_triangles(fine, fine.criterion(), fine.bounds(), most, options,
                                       work.executor);
    };
    const auto flat_within = [&](const VirtualRefinement& fine, double error) {
        ShadingOptions flat = options;
        flat.flatness = std::min(flat.flatness, error);
        return engine::triangulate(fine, scale.value_or(0), fine.criterion(), fine.bounds(), flat,
                                   work.executor);
    };
    if (auto drawn = engine::collapsed_within_error<Shading>(
            prerolls, projection, work, 2, flat_within,
            collapsing_colours<Shading>(scale.value_or(0), work))) {
        return *std::move(drawn);
    }
    if (auto drawn = engine::within_error<Shading>(prerolls, projection, work, 2, within, count)) {
        refine_asked(*drawn, prerolls, projection, work);
        return *std::move(drawn);
    }
    return engine::with_field(prerolls, work, 2, [&](const auto& hierarchy) {
        const Criteria criteria(prerolls, engine::told(projection), {}, work);
        return draw_shading(hierarchy, scale, criteria, options, work);
    });
}

/// What is drawn of polynomials.
engine::DrawnParts parts_of(const SliceRequest& request, const IsosurfaceOptions& options) {
    engine::DrawnParts parts = engine::zeros_of(request.functions, options.cap);
    parts.values = engine::isosurfaces_at(request.isovalues, options.cap).values;
    return parts;
}

}  // namespace

ColourRefinement refine_colours(Surface<3>& surface, const Prerolls& prerolls, double tolerance,
                                const Projection& projection, const Work& work) {
    const auto data = engine::polynomials_for(prerolls, projection, work);
    if (data != nullptr) set_polynomial_colours(surface, *data);
    return detail::refine_colours(surface, tolerance, [&](std::span<const Point> points) {
        return data != nullptr ? probe(*data, points) : probe(prerolls, points, projection, work);
    });
}

Projected<Slice> slice(const Prerolls& prerolls, const LevelFunction& function,
                       const Projection& projection, const IsosurfaceOptions& options,
                       const Work& work) {
    engine::check_first(prerolls, projection, work, "slices", [&] {
        engine::refuse_distance(projection);
        if (options.cap) engine::refuse_slice_distance(projection);
    });
    const auto within = [&](const VirtualRefinement& fine) {
        return engine::slice(fine, function, fine.criterion(), fine.bounds(), options,
                             work.executor);
    };
    const auto count = [&](const VirtualRefinement& fine, std::uint64_t most) {
        return engine::count_triangles(fine, {{&function}}, fine.criterion(), fine.bounds(), most,
                                       options, work.executor);
    };
    if (auto drawn = engine::collapsed_within_error<Slice>(
            prerolls, projection, work, 3,
            [&](const VirtualRefinement& fine, double) { return within(fine); },
            collapsing_colours<Slice>(0, work))) {
        return *std::move(drawn);
    }
    const LevelFunction* const only = &function;
    if (auto drawn =
            engine::within_error<Slice>(prerolls, projection, work, 3, within, count,
                                        engine::zeros_of(std::span(&only, 1), options.cap))) {
        refine_asked(*drawn, prerolls, projection, work);
        return *std::move(drawn);
    }
    return engine::with_field(prerolls, work, 3, [&](const auto& hierarchy) {
        if (projection.draws_everything()) {
            work.begin("drawing");
            Projected<Slice> drawn{engine::slice(hierarchy, function, options, work.executor)};
            if (projection.colour_tolerance > 0 && !drawn.cancelled) {
                refine_colours(drawn.surface, hierarchy, projection.colour_tolerance);
            }
            return drawn;
        }
        const Criteria criteria(prerolls, engine::told(projection), {}, work);
        return draw_slice(hierarchy, function, criteria, options, work);
    });
}

std::vector<Slice> detail::draw_slices(const Prerolls& prerolls, const SliceRequest& request,
                                       const SurfaceTargets<3>& targets,
                                       const Projection& projection,
                                       const IsosurfaceOptions& options, const Work& work) {
    engine::check_one_walk(prerolls, projection, work, "several slices");
    return engine::draw_once(
        prerolls, projection, request.isovalues, work, 3,
        [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
            return engine::slices(hierarchy, request, targets, criterion, bounds, options,
                                  work.executor);
        },
        parts_of(request, options));
}

std::optional<std::uint64_t> count_triangles(const Prerolls& prerolls, const SliceRequest& request,
                                             const Projection& projection, std::uint64_t most,
                                             const IsosurfaceOptions& options, const Work& work) {
    engine::check_one_walk(prerolls, projection, work, "several slices");
    try {
        return engine::draw_once(
            prerolls, projection, request.isovalues, work, 3,
            [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
                return engine::count_triangles(hierarchy, request, criterion, bounds, most, options,
                                               work.executor);
            },
            parts_of(request, options));
    } catch (const engine::Cancelled&) {
        return std::nullopt;
    }
}

std::optional<std::uint64_t> count_triangles(const Prerolls& prerolls, const Projection& projection,
                                             std::uint64_t most, const ShadingOptions& options,
                                             const Work& work) {
    engine::check_one_walk(prerolls, projection, work, "shadings");
    return engine::draw_once(
        prerolls, projection, {}, work, 2,
        [&](const auto& hierarchy, const Criterion& criterion, const Bounds& bounds) {
            return engine::count_triangles(hierarchy, criterion, bounds, most, options,
                                           work.executor);
        });
}

Projected<Slice> boundary_surface(const Prerolls& prerolls, const Projection& projection,
                                  const IsosurfaceOptions& options, const Work& work) {
    engine::refuse_slice_distance(projection);
    return slice(prerolls, detail::Everywhere{}, projection, detail::capped(options), work);
}

Projected<Shading> shading(const Prerolls& prerolls, const Projection& projection,
                           const ShadingOptions& options, const Work& work) {
    return shaded(prerolls, std::nullopt, projection, options, work);
}

Projected<Shading> height_field(const Prerolls& prerolls, double scale,
                                const Projection& projection, const ShadingOptions& options,
                                const Work& work) {
    return shaded(prerolls, scale, projection, options, work);
}

}  // namespace nestgrid
