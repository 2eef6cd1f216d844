// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "extract.hpp"

#include <chrono>

#include <nestgrid/adapters/tbb.hpp>
#include <nestgrid/adapters/vtk_surface.hpp>
#include <nestgrid/algorithms/region.hpp>
#include <nestgrid/error.hpp>

#include "hierarchy.hpp"
#include "memory.hpp"

namespace {

std::string millions(std::uint64_t count) {
    return std::to_string(count / 100000 / 10) + "." + std::to_string(count / 100000 % 10) +
           " million";
}

nestgrid::IsosurfaceOptions options_of(const ExtractionRequest& request) {
    nestgrid::IsosurfaceOptions options{
        .normals = request.normals, .cap = request.cap, .at_nodes = request.at_nodes};
    if (request.progress) {
        options.progress = [&](const nestgrid::TraversalCounts& counts) {
            request.progress("looked at " + millions(counts.calls) + " elements");
            return true;
        };
    }
    return options;
}

/// Draws one surface.
/// \param e takes what the surface costs and, where it is kept, the surface
template <int dimension, class Real>
void extract_one(const nestgrid::Hierarchy<Real>& hierarchy, const nestgrid::Criterion& criterion,
                 const nestgrid::Bounds& bounds, const nestgrid::TbbExecutor& executor,
                 const ExtractionRequest& request, Extraction& e) {
    const std::size_t before = memory::current();
    memory::reset_peak();
    const double start = now();
    const auto result = nestgrid::isosurface<dimension>(hierarchy, request.isovalue, criterion,
                                                        bounds, options_of(request), executor);
    e.seconds = now() - start;
    const std::size_t peak = memory::peak() - before;
    e.peak_bytes = peak - std::min(peak, result.surface.memory_bytes());
    e.counts = result.counts;
    e.error_bound = result.error_bound;
    e.stack_bytes = result.stack_bytes;
    if constexpr (dimension == 3) {
        e.report = nestgrid::surface_report(result.surface);
    } else {
        e.report.vertices = result.surface.vertices.size();
        e.report.triangles = result.surface.simplices.size();
    }
    if (request.keep_surfaces) e.surface = nestgrid::make_poly_data(result.surface);
}

/// The box of a request as a region; none where there is no box.
/// \param make_region makes the region of a function bool(const Point&)
template <class MakeRegion>
std::optional<nestgrid::Region> box_region(const ExtractionRequest& request, int dimension,
                                           const MakeRegion& make_region) {
    if (!request.box) return std::nullopt;
    if (request.progress) request.progress("region");
    return make_region([bounds = request.box->bounds, dimension](const nestgrid::Point& x) {
        for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
            if (x[d] < bounds[2 * d] || x[d] > bounds[2 * d + 1]) return false;
        }
        return true;
    });
}

/// Calls draw(criterion_at) with the function that makes, in a box, the criterion for a threshold.
template <class Draw>
void with_box(const nestgrid::Indicator& indicator, const nestgrid::Region& region,
              const ExtractionRequest& request, const Draw& draw) {
    draw([&](double threshold) {
        return nestgrid::fine_inside(region, indicator, threshold, request.box->threshold);
    });
}

/// Draws all surfaces of one field, at thresholds and budgets.
template <int dimension, class Real>
void extract_field(const nestgrid::Hierarchy<Real>& hierarchy, const ChosenIndicator& indicators,
                   const std::optional<nestgrid::Region>& region,
                   const nestgrid::TbbExecutor& executor, const ExtractionRequest& request,
                   ExtractionRun& run) {
    const nestgrid::HierarchicalIndicator& offsets = indicators.offsets();
    const auto draw = [&](const auto& criterion_at) {
        for (const std::uint64_t budget : request.budgets) {
            Extraction& e = run.surfaces.emplace_back();
            e.budget = budget;
            const double start = now();
            e.search =
                nestgrid::find_threshold<dimension>(hierarchy, request.isovalue, criterion_at,
                                                    offsets, budget, options_of(request), executor);
            e.search_seconds = now() - start;
            e.threshold = e.search.threshold;
            extract_one<dimension>(hierarchy, criterion_at(e.threshold), offsets, executor, request,
                                   e);
        }
        for (const ThresholdText& t : request.thresholds) {
            Extraction& e = run.surfaces.emplace_back();
            e.threshold = indicators.threshold(t);
            extract_one<dimension>(hierarchy, criterion_at(e.threshold), offsets, executor, request,
                                   e);
        }
    };
    if (region) {
        with_box(indicators.chosen(), *region, request, draw);
    } else {
        indicators.with_criteria(draw);
    }
}

template <class Grid, class Field>
void extract_all(const Grid& grid, const Field& field, const ExtractionRequest& request,
                 ExtractionRun& run) {
    run.dimension = Grid::dimension;
    const std::size_t before = memory::current();
    memory::reset_peak();
    const double start = now();
    if (request.progress) request.progress("preroll");
    const nestgrid::TbbExecutor executor(request.threads);
    const auto erased = nestgrid::erase(grid, field);
    const nestgrid::Hierarchy<typename Field::value_type>& hierarchy = erased;
    const ChosenIndicator indicators(hierarchy, request.projection, request.lens, executor);
    run.preroll_seconds = now() - start;
    run.preroll_peak_bytes = memory::peak() - before;
    run.preroll_kept_bytes = indicators.memory_bytes();
    run.least = indicators.offsets().least();
    run.greatest = indicators.offsets().greatest();
    const auto region = box_region(request, Grid::dimension, [&](const auto& inside) {
        return nestgrid::Region(grid, inside);
    });
    extract_field<Grid::dimension>(hierarchy, indicators, region, executor, request, run);
}

/// Draws the surfaces at one time between frames, one for each threshold.
template <int dimension, class Real>
void extract_time(double t, const nestgrid::Hierarchy<Real>& hierarchy,
                  const nestgrid::KeyFrames& indicator,
                  const std::optional<nestgrid::Region>& region, const ExtractionRequest& request,
                  ExtractionRun& run) {
    const nestgrid::TbbExecutor executor(request.threads);
    const auto draw = [&](const auto& criterion_at) {
        for (const ThresholdText& threshold : request.thresholds) {
            Extraction& e = run.surfaces.emplace_back();
            e.time = t;
            e.threshold = threshold.in_units(run.greatest - run.least);
            extract_one<dimension>(hierarchy, criterion_at(e.threshold), indicator, executor,
                                   request, e);
            if (request.drawn) request.drawn(e);
        }
    };
    if (region) {
        with_box(indicator, *region, request, draw);
    } else {
        draw([&](double threshold) { return nestgrid::Threshold(&indicator, threshold); });
    }
}

}  // namespace

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

ExtractionRun extract(const Volume& volume, const ExtractionRequest& request) {
    const nestgrid::LatticeBisection<3> grid(volume.geometry);
    ExtractionRun run;
    run.nodes = volume.sample_count();
    run.leaf_elements = leaf_count(grid);
    with_samples(volume, [&](auto samples) {
        extract_all(grid, nestgrid::LatticeField(grid, samples), request, run);
    });
    return run;
}

ExtractionRun extract(const std::filesystem::path& hierarchy, const std::string& array,
                      const ExtractionRequest& request) {
    ExtractionRun run;
    with_hierarchy(hierarchy, [&](const auto& stored) {
        const nestgrid::NodeField field(stored.grid, field_named(stored.fields, array).values);
        run.nodes = stored.grid.used_node_count();
        run.leaf_elements = stored.grid.leaf_count();
        extract_all(stored.grid, field, request, run);
    });
    return run;
}

ExtractionRun extract(Input& input, const TimeOptions& time, const ExtractionRequest& request) {
    ExtractionRun run;
    with_frames(input, time, request.threads, [&](const Frames& frames) {
        run.dimension = frames.dimension;
        run.nodes = frames.nodes;
        run.leaf_elements = frames.leaf_elements;
        run.least = frames.least;
        run.greatest = frames.greatest;
        run.preroll_seconds = frames.preroll_seconds;
        run.preroll_kept_bytes = frames.preroll_bytes;
        const auto region =
            box_region(request, frames.dimension,
                       [&](const Frames::Inside& inside) { return frames.region(inside); });
        for (const double t : time.drawn_times()) {
            frames.at(time.weights(t), [&](const auto& hierarchy, const auto& indicator) {
                if (frames.dimension == 3) {
                    extract_time<3>(t, hierarchy, indicator, region, request, run);
                } else {
                    extract_time<2>(t, hierarchy, indicator, region, request, run);
                }
            });
        }
    });
    return run;
}
