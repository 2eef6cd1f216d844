// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/extract.hpp"

#include <chrono>

#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/collapse_budget.hpp>
#include <nestgrid/algorithms/isosurface_within.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/error.hpp>

#include "drawing/memory.hpp"

namespace {

std::string millions(std::uint64_t count) {
    return std::to_string(count / 100000 / 10) + "." + std::to_string(count / 100000 % 10) +
           " million";
}

/// \param counting whether elements are told, where no share of the work is known
nestgrid::IsosurfaceOptions options_of(const ExtractionRequest& request, bool counting) {
    const std::string& indicator = request.projection.indicator;
    const bool finest = indicator == "slope" || (!request.budgets.empty() && !request.collapses &&
                                                 indicator != "deviation");
    nestgrid::IsosurfaceOptions options{
        .cuts = request.cuts.value_or(finest ? nestgrid::Cuts::finest : nestgrid::Cuts::linear),
        .normals = request.normals,
        .cap = request.cap,
        .at_nodes = request.at_nodes};
    if (request.progress && counting) {
        options.progress = [&](const nestgrid::TraversalCounts& counts) {
            request.progress("looked at " + millions(counts.calls) + " elements");
            return true;
        };
    }
    return options;
}

/// Collapses edges of a surface, and tells what is left and its bounds.
template <class Real>
void collapse_one(nestgrid::Surface<3>& surface, const nestgrid::Surface<3>& whole,
                  const nestgrid::Hierarchy<Real>& hierarchy, const nestgrid::Bounds& bounds,
                  const nestgrid::Executor& executor, const ExtractionRequest& request,
                  Extraction& e) {
    if (request.progress) request.progress("collapsing");
    const double start = now();
    nestgrid::CollapseOptions options;
    if (request.keeps_distances)
        options.nearness.emplace(nestgrid::Nearness{whole, e.threshold});
    else
        options.error = e.threshold;
    const nestgrid::Collapsed done =
        nestgrid::collapse(surface, hierarchy, request.isovalue, bounds, options, executor);
    e.collapse_seconds = now() - start;
    e.collapsed = done;
    done.hand_to(e.bounds, e.surface_error);
}

/// Measures a surface against that of all data.
template <class Real>
void measure_one(const nestgrid::Surface<3>& surface, const nestgrid::Surface<3>& whole,
                 const nestgrid::Hierarchy<Real>& hierarchy, const nestgrid::Executor& executor,
                 const ExtractionRequest& request, Extraction& e) {
    constexpr std::size_t points = 200000;
    if (request.progress) request.progress("measuring");
    const double start = now();
    e.measured =
        nestgrid::measure_error(surface, whole, hierarchy, request.isovalue, points, executor);
    e.measure_seconds = now() - start;
}

/// The threshold of what is drawn before edges are collapsed.
double first_threshold(const ExtractionRequest& request, double threshold) {
    if (!request.collapses) return threshold;
    return request.keeps_distances ? threshold / 2 : nestgrid::begun_with * threshold;
}

/// Draws one surface.
/// \param e takes what the surface costs and, where it is kept, the surface
template <int dimension, class Real, class S>
void extract_one(const nestgrid::Hierarchy<Real>& hierarchy, const S& criterion,
                 const nestgrid::Bounds& bounds, const nestgrid::Executor& executor,
                 const ExtractionRequest& request, Extraction& e) {
    const nestgrid::IsosurfaceOptions options = options_of(request, executor.concurrency() == 1);
    const auto draw = [&](const nestgrid::Criterion& by, const nestgrid::IsosurfaceOptions& how) {
        return nestgrid::isosurface<dimension>(hierarchy, request.isovalue, by, bounds, how,
                                               executor);
    };
    nestgrid::Surface<dimension> whole;
    if (request.measures || request.keeps_distances) {
        whole = draw(nestgrid::Exact{}, {.elements = false, .at_nodes = request.at_nodes}).surface;
    }
    const std::size_t before = memory::current();
    memory::reset_peak();
    const double start = now();
    nestgrid::Isosurface<dimension> result;
    if constexpr (dimension == 3) {
        if (request.keeps_distances) {
            const double distance = first_threshold(request, e.threshold);
            nestgrid::IsosurfaceWithin within =
                nestgrid::isosurface_within(hierarchy, request.isovalue, {whole, distance},
                                            criterion, bounds, options, executor);
            e.far_points = within.points;
            result = std::move(within.isosurface);
        }
    }
    if (!request.keeps_distances) result = draw(criterion, options);
    e.seconds = now() - start;
    const std::size_t peak = memory::peak() - before;
    e.peak_bytes = peak - std::min(peak, result.surface.memory_bytes());
    e.counts = result.counts;
    e.bounds = result;
    e.surface_error = result.surface_error;
    e.stack_bytes = result.stack_bytes;
    if constexpr (dimension == 3) {
        if (request.collapses && e.threshold > 0) {
            collapse_one(result.surface, whole, hierarchy, bounds, executor, request, e);
        }
        if (request.measures) measure_one(result.surface, whole, hierarchy, executor, request, e);
        e.report = nestgrid::surface_report(result.surface);
    } else {
        e.report.vertices = result.surface.vertices.size();
        e.report.triangles = result.surface.simplices.size();
    }
    if (request.keep_surfaces) e.surface = nestgrid::make_poly_data(result.surface);
}

/// The box of a request as a region; none where there is no box.
std::optional<nestgrid::Region> box_region(const ExtractionRequest& request, int dimension,
                                           const InputField& field) {
    if (!request.box) return std::nullopt;
    if (request.progress) request.progress("region");
    return field.region([bounds = request.box->bounds, dimension](const nestgrid::Point& x) {
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
            if (x[d] < bounds[2 * d] || x[d] > bounds[2 * d + 1]) return false;
        }
        return true;
    });
}

/// Calls draw(criterion_at) with the function that makes a criterion of a threshold.
template <class Draw>
void with_criteria(const ChosenIndicator& indicators, const std::optional<nestgrid::Region>& region,
                   const ExtractionRequest& request, const Draw& draw) {
    if (!region) return indicators.with_criteria(draw);
    draw([&](double threshold) {
        return nestgrid::fine_inside(*region, indicators.chosen(), threshold,
                                     request.box->threshold);
    });
}

/// The least threshold whose surface keeps within a number of triangles, after collapses where
/// there are any.
template <int dimension, class Real, class CriterionAt, class Offsets>
nestgrid::TriangleBudget find_fitting(const nestgrid::Hierarchy<Real>& hierarchy,
                                      const CriterionAt& criterion_at, const Offsets& offsets,
                                      std::uint64_t budget, const nestgrid::Executor& executor,
                                      const ExtractionRequest& request) {
    const nestgrid::IsosurfaceOptions options = options_of(request, true);
    if constexpr (dimension == 3) {
        if (request.collapses) {
            return nestgrid::find_collapse_error(hierarchy, request.isovalue, criterion_at, offsets,
                                                 budget, options, executor);
        }
    }
    return nestgrid::find_threshold<dimension>(hierarchy, request.isovalue, criterion_at, offsets,
                                               budget, options, executor);
}

void tell_share(const ExtractionRun& run, const ExtractionRequest& request) {
    if (request.share) request.share(run.surfaces.size(), run.expected);
}

/// Draws all surfaces at one moment, at thresholds and budgets.
template <int dimension, class Real>
void extract_moment(const nestgrid::Hierarchy<Real>& hierarchy, const Moment& moment,
                    const std::optional<nestgrid::Region>& region,
                    const nestgrid::Executor& executor, const ExtractionRequest& request,
                    const InputField& field, ExtractionRun& run) {
    const double begin = now();
    const ChosenIndicator& indicators = moment.indicators();
    run.preroll_seconds += now() - begin;
    const auto draw = [&](const auto& criterion_at, Extraction e) {
        e.time = moment.time();
        extract_one<dimension>(hierarchy, criterion_at(first_threshold(request, e.threshold)),
                               indicators.bounds(), executor, request, e);
        if (e.surface)
            describe(e.surface, field.length_unit, field.space, {{field.name, request.isovalue}});
        run.surfaces.push_back(std::move(e));
        if (request.drawn) request.drawn(run.surfaces.back());
    };
    with_criteria(indicators, region, request, [&](const auto& criterion_at) {
        for (const std::uint64_t budget : request.budgets) {
            if (request.progress) request.progress("searching the threshold");
            Extraction e;
            const double start = now();
            e.search = indicators.with_offsets([&](const auto& offsets) {
                return find_fitting<dimension>(hierarchy, criterion_at, offsets, budget, executor,
                                               request);
            });
            e.search_seconds = now() - start;
            e.threshold = e.search.threshold;
            tell_share(run, request);
            draw(criterion_at, std::move(e));
        }
        for (const ThresholdText& t : request.thresholds) {
            tell_share(run, request);
            Extraction e;
            e.threshold = indicators.threshold(t);
            draw(criterion_at, std::move(e));
        }
    });
}

/// Makes the prerolls of all frames, and measures what they cost.
void preroll(const Moments& moments, const ExtractionRequest& request, ExtractionRun& run) {
    const std::size_t before = memory::current();
    memory::reset_peak();
    const double start = now();
    if (request.preroll) request.preroll();
    const FramePrerolls& prerolls = moments.prerolls();
    run.preroll_seconds = now() - start;
    run.preroll_peak_bytes = memory::peak() - before;
    run.preroll_kept_bytes = prerolls.memory_bytes();
    run.least = prerolls.least();
    run.greatest = prerolls.greatest();
}

}  // namespace

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

ExtractionRun extract(const InputField& field, const TimeOptions& time,
                      const std::filesystem::path& path, const ExtractionRequest& request) {
    ExtractionRun run;
    const Moments moments(field, time, path, request.projection, request.lens, request.threads,
                          request.part);
    run.dimension = std::visit([](const auto& frame) { return frame->facts().dimension; },
                               field.frames.front());
    run.nodes = field.nodes;
    run.leaf_elements = field.leaf_elements;
    const std::size_t moment_count = time.frames ? static_cast<std::size_t>(*time.frames) : 1;
    run.expected = moment_count * (request.budgets.size() + request.thresholds.size());
    preroll(moments, request, run);
    const auto region = box_region(request, run.dimension, field);
    moments.for_each([&](const Moment& moment) {
        moment.visit([&](const auto& hierarchy) {
            if (run.dimension == 3) {
                extract_moment<3>(hierarchy, moment, region, moments.executor(), request, field,
                                  run);
            } else {
                extract_moment<2>(hierarchy, moment, region, moments.executor(), request, field,
                                  run);
            }
        });
    });
    return run;
}
