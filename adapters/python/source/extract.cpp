// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "extract.hpp"

#include <limits>

#include <nestgrid/algorithms/drawing.hpp>

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

Projection asked(const Source& source, Projection projection, const SurfaceRequest& request,
                 const Call& call) {
    projection.collapse = request.collapses;
    projection.keeps_distance = request.keeps_distance;
    projection.slice_distance = request.slice_distance;
    return with_error(source.prerolls(), std::move(projection), call.work());
}

template <class Result>
Drawn drawn_of(Projected<Result> result, double surface_error) {
    return {static_cast<const ErrorBounds&>(result),
            std::move(result.surface),
            result.counts,
            result.search.threshold,
            result.position_bound,
            surface_error,
            result.budget_reason(),
            result.cancelled};
}
Drawn drawn_of(Projected<Isosurface<3>> result) {
    const double surface_error = result.surface_error;
    return drawn_of(std::move(result), surface_error);
}

}  // namespace

Drawn draw_isosurface(const Source& source, double isovalue, const SurfaceRequest& request,
                      const Projection& projection, const Call& call) {
    return drawn_of(isosurface<3>(source.prerolls(), isovalue,
                                  asked(source, projection, request, call),
                                  options_of(request, call), call.work()));
}

std::vector<Drawn> draw_isosurfaces(const Source& source, std::span<const double> isovalues,
                                    const SurfaceRequest& request, const Projection& projection,
                                    const Call& call) {
    const Projection finely = asked(source, projection, request, call);
    std::vector<Drawn> all;
    for (Isosurface<3>& each : isosurfaces<3>(source.prerolls(), isovalues, finely,
                                              options_of(request, call), call.work())) {
        all.push_back(drawn_of(
            Projected<Isosurface<3>>{std::move(each), {.threshold = finely.least_threshold()}}));
    }
    return all;
}

Drawn draw_isoband(const Source& source, double low, double high, const SurfaceRequest& request,
                   const Projection& projection, const Call& call) {
    return drawn_of(isoband<3>(source.prerolls(), low, high,
                               asked(source, projection, request, call), options_of(request, call),
                               call.work()));
}

Drawn draw_boundary(const Source& source, const SurfaceRequest& request,
                    const Projection& projection, const Call& call) {
    return drawn_of(boundary_surface(source.prerolls(), asked(source, projection, request, call),
                                     options_of(request, call), call.work()));
}

Drawn draw_slice(const Source& source, const LevelFunction& function, const SurfaceRequest& request,
                 const Projection& projection, const Call& call) {
    return drawn_of(slice(source.prerolls(), function, asked(source, projection, request, call),
                          options_of(request, call), call.work()));
}

DrawnLines draw_isolines(const Source& source, std::span<const double> values,
                         const Projection& projection, const Call& call) {
    Projected<Isolines> result =
        isolines(source.prerolls(), values, asked(source, projection, {}, call),
                 {.progress = progress_of(call)}, call.work());
    return {static_cast<const ErrorBounds&>(result),
            std::move(result.lines),
            result.counts,
            result.search.threshold,
            result.position_bound,
            result.cancelled};
}

Drawn draw_height_field(const Source& source, std::optional<double> scale, double flatness,
                        const SurfaceRequest& request, const Projection& projection,
                        const Call& call) {
    const Projection finely = asked(source, projection, request, call);
    const ShadingOptions options{
        .flatness = flatness, .elements = request.elements, .progress = progress_of(call)};
    return drawn_of(scale ? height_field(source.prerolls(), *scale, finely, options, call.work())
                          : shading(source.prerolls(), finely, options, call.work()),
                    std::numeric_limits<double>::infinity());
}

ProbeResult probe_points(const Source& source, std::span<const Point> points,
                         const Projection& projection, const Call& call) {
    return probe(source.prerolls(), points, asked(source, projection, {}, call), call.work());
}

}  // namespace nestgrid::python
