// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "extract.hpp"

#include <cmath>

#include <nestgrid/algorithms/blended.hpp>
#include <nestgrid/algorithms/collapse_budget.hpp>
#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/lens.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/slices.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>
#include <nestgrid/error.hpp>

namespace nestgrid::python {

namespace {

/// The criteria of a projection for one source, and what they are made of.
class Criteria {
public:
    /// \throw InvalidInput where a number is out of range
    /// \param isovalue of an isosurface; nothing for other extractions
    Criteria(const Source& source, const Projection& projection, const Call& call,
             std::optional<double> isovalue = std::nullopt)
        : projection_{projection} {
        if (!(projection.blend >= 1) || !std::isfinite(projection.blend)) {
            throw InvalidInput("blend is not a finite number of at least 1");
        }
        if (!(threshold() >= 0)) throw InvalidInput("the threshold is not a number >= 0");
        chosen_ = isovalue ? choose_for(source, *isovalue, call)
                           : source.choose(projection.indicator, projection.blend, call);
        if (!projection.lens) return;
        if (!(projection.lens->slope >= 0) || !std::isfinite(projection.lens->slope)) {
            throw InvalidInput("the slope of the lens is not a finite number >= 0");
        }
        sizes_ = source.sizes(projection.lens->slope, call);
    }

    double threshold() const {
        const double any = std::numeric_limits<double>::infinity();
        return projection_.threshold.value_or(projection_.lens ? any : 0);
    }
    const Bounds& bounds() const { return *chosen_.bounds; }

    /// Calls function(criterion_at) with the function that makes a criterion of a threshold.
    template <class Function>
    auto with_criteria(const Function& function) const {
        const Indicator* const indicator = chosen_.indicator.get();
        if (projection_.blend == 1) {
            return in_lens(function, [=](double t) { return Threshold(indicator, t); });
        }
        return in_lens(function, [=, blend = projection_.blend](double t) {
            return Blended(indicator, t, blend);
        });
    }

    /// Calls function(offsets) with the HierarchicalIndicator of the field, or with KeyFrames.
    template <class Function>
    auto with_offsets(const Function& function) const {
        return std::visit([&](const auto* offsets) { return function(*offsets); }, chosen_.ranged);
    }

private:
    /// The indicator of one isosurface. Between frames the deviations of these serve, without a
    /// preroll of each moment.
    ChosenIndicator choose_for(const Source& source, double isovalue, const Call& call) const {
        const std::string& name = projection_.indicator;
        if (name != "error" && name != "cut" && name != "slope") {
            return source.choose(name, projection_.blend, call);
        }
        return call.with(source.hierarchy(), [&](const auto& hierarchy) {
            ChosenIndicator chosen = source.choose("offset", 1, call);
            const bool between = std::holds_alternative<const KeyFrames*>(chosen.ranged);
            if (name == "error" && (between || !cuts_are_errors(hierarchy.facts()))) {
                return source.choose("deviation", projection_.blend, call);
            }
            const auto measure = [&](const auto& function) {
                return std::make_shared<SweptIndicator>(
                    function(hierarchy, std::span(&isovalue, 1), *chosen.bounds,
                             Spread{.factor = projection_.blend}, call.executor()));
            };
            chosen.indicator =
                name == "slope" ? measure([](const auto&... a) { return slope_deviations(a...); })
                                : measure([](const auto&... a) { return cut_deviations(a...); });
            return chosen;
        });
    }

    template <class Function, class CriterionAt>
    auto in_lens(const Function& function, const CriterionAt& criterion_at) const {
        if (!projection_.lens) return function(criterion_at);
        const LensRequest& request = *projection_.lens;
        const Lens lens(sizes_.get(), request.distance,
                        {.finest = request.finest, .coarsest = request.coarsest});
        return function([&](double t) { return criterion_at(t) && lens; });
    }

    const Projection& projection_;
    ChosenIndicator chosen_;
    std::shared_ptr<const SweptIndicator> sizes_;  // where there is a lens
};

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
template <class Real, class CriterionAt>
Isosurface<3> draw_one(const Hierarchy<Real>& hierarchy, double isovalue,
                       const CriterionAt& criterion_at, double threshold, const Bounds& bounds,
                       const SurfaceRequest& request, const Call& call) {
    const IsosurfaceOptions options = options_of(request, call);
    const auto draw = [&](const Criterion& by, const IsosurfaceOptions& how) {
        return isosurface<3>(hierarchy, isovalue, by, bounds, how, call.executor());
    };
    const double part = request.keeps_distance ? 0.5 : begun_with;
    const double first = request.collapses ? part * threshold : threshold;
    const auto criterion = criterion_at(first);
    CollapseOptions kept;
    Isosurface<3> whole;
    Isosurface<3> drawn;
    if (request.keeps_distance) {
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

bool is_default(const Projection& projection) {
    return projection.indicator == "offset" && projection.blend == 1 && !projection.lens;
}

}  // namespace

Drawn draw_isosurface(const Source& source, double isovalue, const SurfaceRequest& request,
                      const Projection& projection, const Call& call) {
    return call.with(source.hierarchy(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(3);
        const Criteria criteria(source, projection, call, isovalue);
        return criteria.with_criteria([&](const auto& criterion_at) {
            TriangleBudget search{.threshold = criteria.threshold()};
            if (projection.max_triangles > 0) {
                const auto find = [&](const auto& function) {
                    return criteria.with_offsets([&](const auto& offsets) {
                        return function(hierarchy, isovalue, criterion_at, offsets,
                                        projection.max_triangles, options_of(request, call),
                                        call.executor());
                    });
                };
                search = request.collapses
                             ? find([](const auto&... a) { return find_collapse_error(a...); })
                             : find([](const auto&... a) { return find_threshold<3>(a...); });
            }
            return drawn_of(draw_one(hierarchy, isovalue, criterion_at, search.threshold,
                                     criteria.bounds(), request, call),
                            search);
        });
    });
}

Drawn draw_slice(const Source& source, const LevelFunction& function, const SurfaceRequest& request,
                 const Projection& projection, const Call& call) {
    return call.with(source.hierarchy(), [&](const auto& hierarchy) {
        const IsosurfaceOptions options = options_of(request, call);
        const bool everything =
            projection.threshold.value_or(0) == 0 && projection.max_triangles == 0;
        if (is_default(projection) && everything) {
            return drawn_of(slice(hierarchy, function, options, call.executor()), {});
        }
        const Criteria criteria(source, projection, call);
        return criteria.with_criteria([&](const auto& criterion_at) {
            TriangleBudget search{.threshold = criteria.threshold()};
            if (projection.max_triangles > 0) {
                search = criteria.with_offsets([&](const auto& offsets) {
                    return find_threshold(hierarchy, function, criterion_at, offsets,
                                          projection.max_triangles, options, call.executor());
                });
            }
            const double error = search.threshold;
            const auto criterion = criterion_at(request.collapses ? error / 2 : error);
            Slice drawn =
                slice(hierarchy, function, criterion, criteria.bounds(), options, call.executor());
            if (request.collapses && error > 0 && !drawn.cancelled) {
                refine_colours(drawn.surface, hierarchy, error / 2, criterion, criteria.bounds());
                collapse_colours(drawn.surface, hierarchy, criteria.bounds(), {.errors = {error}},
                                 call.executor())
                    .hand_to(drawn, drawn.surface_error);
            }
            return drawn_of(std::move(drawn), search);
        });
    });
}

DrawnLines draw_isolines(const Source& source, std::span<const double> values,
                         const Projection& projection, const Call& call) {
    return call.with(source.hierarchy(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(2);
        const Criteria criteria(source, projection, call);
        return criteria.with_criteria([&](const auto& criterion_at) {
            Isolines result =
                isolines(hierarchy, values, criterion_at(criteria.threshold()), criteria.bounds(),
                         IsosurfaceOptions{.progress = progress_of(call)}, call.executor());
            return DrawnLines{static_cast<const ErrorBounds&>(result), std::move(result.lines),
                              result.counts, criteria.threshold(), result.cancelled};
        });
    });
}

Drawn draw_height_field(const Source& source, std::optional<double> scale, double flatness,
                        const SurfaceRequest& request, const Projection& projection,
                        const Call& call) {
    return call.with(source.hierarchy(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(2);
        const Criteria criteria(source, projection, call);
        const double error = criteria.threshold();
        const double first = request.collapses ? error / 2 : error;
        const ShadingOptions options{
            .flatness = request.collapses ? std::min(flatness, first) : flatness,
            .elements = request.elements,
            .progress = progress_of(call)};
        return criteria.with_criteria([&](const auto& criterion_at) {
            const auto s = criterion_at(first);
            Shading result =
                scale ? height_field(hierarchy, *scale, s, criteria.bounds(), options,
                                     call.executor())
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
                         {},
                         result.cancelled};
        });
    });
}

ProbeResult probe_points(const Source& source, std::span<const Point> points,
                         const Projection& projection, const Call& call) {
    return call.with(source.hierarchy(), [&](const auto& hierarchy) {
        if (is_default(projection) && projection.threshold.value_or(0) == 0) {
            return probe(hierarchy, points);
        }
        const Criteria criteria(source, projection, call);
        return criteria.with_criteria([&](const auto& criterion_at) {
            return probe(hierarchy, points, criterion_at(criteria.threshold()), criteria.bounds());
        });
    });
}

}  // namespace nestgrid::python
