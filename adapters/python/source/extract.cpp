// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "extract.hpp"

#include <limits>

#include <nestgrid/algorithms/collapse_budget.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/criteria.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::python {

namespace {

/// Ends extractions between two parts of their work.
std::function<bool(const TraversalCounts&)> progress_of(const Call& call) {
    return [&call](const TraversalCounts&) { return !call.stopped(); };
}

IsosurfaceOptions options_of(const SurfaceRequest& request, const Call& call) {
    return {.cuts = request.finest_cuts ? Cuts::finest : Cuts::linear,
            .normals = request.normals,
            .cap = request.cap,
            .elements = request.elements,
            .at_nodes = request.at_nodes,
            .progress = progress_of(call)};
}

/// Draws one isosurface. Where edges are collapsed, what is drawn first has a part of the
/// threshold.
template <class Real>
Isosurface<3> draw_one(const Hierarchy<Real>& hierarchy, double isovalue, const Criteria& criteria,
                       double threshold, const SurfaceRequest& request, const Call& call) {
    const Bounds& bounds = criteria.bounds();
    const IsosurfaceOptions options = options_of(request, call);
    const auto draw = [&](const Criterion& by, const IsosurfaceOptions& how) {
        return isosurface<3>(hierarchy, isovalue, by, bounds, how, call.executor());
    };
    const double part = request.keeps_distance ? 0.5 : collapse_start;
    const double first = request.collapses ? part * threshold : threshold;
    const auto criterion = criteria.at(first);
    CollapseOptions kept;
    Isosurface<3> whole;
    Isosurface<3> drawn;
    if (request.keeps_distance && threshold > 0) {
        whole =
            draw(Exact{},
                 {.elements = false, .at_nodes = options.at_nodes, .progress = options.progress});
        if (whole.cancelled) return whole;
        drawn = isosurface_within(hierarchy, isovalue, {whole.surface, first}, criterion, bounds,
                                  options, call.executor())
                    .isosurface;
        kept.nearness.emplace(Nearness{whole.surface, threshold});
    } else {
        drawn = draw(criterion, options);
        kept.error = threshold;
    }
    if (!request.collapses || threshold == 0 || drawn.cancelled) return drawn;
    const Collapsed done =
        collapse(drawn.surface, hierarchy, isovalue, bounds, kept, call.executor());
    done.hand_to(drawn, drawn.surface_error);
    return drawn;
}

/// Draws a slice whose colours keep an error with few triangles. Where it may move, it begins with
/// that of all data, as only this is as near to the function as the grid allows.
template <class Real>
Slice collapsed_slice(const Hierarchy<Real>& hierarchy, const LevelFunction& function,
                      const Criteria& criteria, double error, const SurfaceRequest& request,
                      const Call& call) {
    const Bounds& bounds = criteria.bounds();
    const bool moves = request.slice_distance > 0;
    const AnyCriterion coarse = criteria.at(error / 2);
    const Exact all;
    const Criterion& criterion = moves ? static_cast<const Criterion&>(all) : coarse;
    Slice drawn =
        slice(hierarchy, function, criterion, bounds, options_of(request, call), call.executor());
    if (drawn.cancelled) return drawn;
    refine_colours(drawn.surface, hierarchy, error / 2, criterion, bounds);
    ColourCollapseOptions options{.errors = {error}};
    Surface<3> whole;
    if (moves) {
        whole = drawn.surface;
        options.nearness.emplace(Nearness{whole, request.slice_distance});
    }
    collapse_colours(drawn.surface, hierarchy, bounds, options, call.executor())
        .hand_to(drawn, drawn.surface_error);
    return drawn;
}

/// \param search of the threshold; its max_triangles is 0 where the threshold was given
Drawn drawn_of(Isosurface<3> result, const TriangleBudget& search) {
    return {static_cast<const ErrorBounds&>(result),
            std::move(result.surface),
            result.counts,
            search.threshold,
            result.surface_error,
            search.max_triangles > 0 ? search.reason() : std::string(),
            result.cancelled};
}

/// The function that find_threshold() asks for criteria.
auto criterion_at(const Criteria& criteria) {
    return [&criteria](double threshold) { return criteria.at(threshold); };
}

/// Finds the threshold of an isosurface with a number of triangles, or the error or the distance
/// within which its edges are collapsed.
template <class Real>
TriangleBudget find_budget(const Hierarchy<Real>& hierarchy, double isovalue,
                           const Criteria& criteria, std::uint64_t max_triangles,
                           const SurfaceRequest& request, const Call& call) {
    const auto at = criterion_at(criteria);
    const auto& bounds = criteria.bounds();
    const IsosurfaceOptions options = options_of(request, call);
    if (!request.collapses) {
        return find_threshold<3>(hierarchy, isovalue, at, bounds, max_triangles, options,
                                 call.executor());
    }
    if (!request.keeps_distance) {
        return find_collapse_error(hierarchy, isovalue, at, bounds, max_triangles, options,
                                   call.executor());
    }
    const Surface<3> whole =
        isosurface<3>(hierarchy, isovalue, Exact{}, bounds,
                      {.elements = false, .progress = options.progress}, call.executor())
            .surface;
    return find_collapse_distance(hierarchy, isovalue, whole, at, bounds, max_triangles, options,
                                  call.executor());
}

}  // namespace

Drawn draw_isosurface(const Source& source, double isovalue, const SurfaceRequest& request,
                      const Projection& projection, const Call& call) {
    return call.with(source.field(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(3);
        const Criteria criteria(source.prerolls(), projection, std::span(&isovalue, 1),
                                call.work());
        TriangleBudget search{.threshold = projection.least_threshold()};
        if (projection.max_triangles > 0) {
            search =
                find_budget(hierarchy, isovalue, criteria, projection.max_triangles, request, call);
        }
        return drawn_of(draw_one(hierarchy, isovalue, criteria, search.threshold, request, call),
                        search);
    });
}

Drawn draw_slice(const Source& source, const LevelFunction& function, const SurfaceRequest& request,
                 const Projection& projection, const Call& call) {
    return call.with(source.field(), [&](const auto& hierarchy) {
        const IsosurfaceOptions options = options_of(request, call);
        if (projection.draws_everything()) {
            return drawn_of(slice(hierarchy, function, options, call.executor()), {});
        }
        const Criteria criteria(source.prerolls(), projection, {}, call.work());
        TriangleBudget search{.threshold = projection.least_threshold()};
        if (projection.max_triangles > 0) {
            search = find_threshold(hierarchy, function, criterion_at(criteria), criteria.bounds(),
                                    projection.max_triangles, options, call.executor());
        }
        if (request.collapses && search.threshold > 0) {
            return drawn_of(
                collapsed_slice(hierarchy, function, criteria, search.threshold, request, call),
                search);
        }
        return drawn_of(slice(hierarchy, function, criteria.at(search.threshold), criteria.bounds(),
                              options, call.executor()),
                        search);
    });
}

DrawnLines draw_isolines(const Source& source, std::span<const double> values,
                         const Projection& projection, const Call& call) {
    return call.with(source.field(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(2);
        const Criteria criteria(source.prerolls(), projection, values, call.work());
        Isolines result =
            isolines(hierarchy, values, criteria.criterion(), criteria.bounds(),
                     IsosurfaceOptions{.progress = progress_of(call)}, call.executor());
        return DrawnLines{static_cast<const ErrorBounds&>(result), std::move(result.lines),
                          result.counts, projection.least_threshold(), result.cancelled};
    });
}

Drawn draw_height_field(const Source& source, std::optional<double> scale, double flatness,
                        const SurfaceRequest& request, const Projection& projection,
                        const Call& call) {
    return call.with(source.field(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(2);
        const Criteria criteria(source.prerolls(), projection, {}, call.work());
        TriangleBudget search{.threshold = projection.least_threshold()};
        const double half = search.threshold / 2;
        const ShadingOptions options{
            .flatness = request.collapses ? std::min(flatness, half) : flatness,
            .elements = request.elements,
            .progress = progress_of(call)};
        if (projection.max_triangles > 0) {
            search = find_shading_threshold(hierarchy, criterion_at(criteria), criteria.bounds(),
                                            projection.max_triangles, options, call.executor());
        }
        const double error = search.threshold;
        const double first = request.collapses ? half : error;
        const AnyCriterion s = criteria.at(first);
        Shading result =
            scale ? height_field(hierarchy, *scale, s, criteria.bounds(), options, call.executor())
                  : shading(hierarchy, s, criteria.bounds(), options, call.executor());
        if (request.collapses && error > 0 && !result.cancelled) {
            double surface_error = 0;
            collapse_colours(result.surface, hierarchy, criteria.bounds(),
                             {.errors = {error}, .scale = scale.value_or(0)}, call.executor())
                .hand_to(result, surface_error);
        }
        return Drawn{static_cast<const ErrorBounds&>(result),
                     std::move(result.surface),
                     result.counts,
                     error,
                     std::numeric_limits<double>::infinity(),
                     search.max_triangles > 0 ? search.reason() : std::string(),
                     result.cancelled};
    });
}

ProbeResult probe_points(const Source& source, std::span<const Point> points,
                         const Projection& projection, const Call& call) {
    return call.with(source.field(), [&](const auto& hierarchy) {
        if (projection.draws_everything()) return probe(hierarchy, points);
        const Criteria criteria(source.prerolls(), projection, {}, call.work());
        return probe(hierarchy, points, criteria.criterion(), criteria.bounds());
    });
}

}  // namespace nestgrid::python
