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

/// \param criterion_at the criterion for a threshold
/// \param budget triangles at most, beside which `threshold` is not used; or 0
template <class Grid, class Field, class MakeCriterion>
Extraction extract_one(const Grid& grid, const Field& field, const MakeCriterion& criterion_at,
                       const nestgrid::HierarchicalIndicator& indicator, double threshold,
                       std::uint64_t budget, const nestgrid::TbbExecutor& executor,
                       const ExtractionRequest& request) {
    Extraction e;
    e.threshold = threshold;
    e.budget = budget;
    nestgrid::IsosurfaceOptions options{
        .normals = request.normals, .cap = request.cap, .at_nodes = request.at_nodes};
    if (request.progress) {
        options.progress = [&](const nestgrid::TraversalCounts& counts) {
            request.progress("looked at " + millions(counts.calls) + " elements");
            return true;
        };
    }
    const std::size_t before = memory::current();
    memory::reset_peak();
    double start = now();
    if (budget > 0) {
        e.search = nestgrid::find_threshold(grid, field, request.isovalue, criterion_at, indicator,
                                            budget, options, executor);
        e.threshold = e.search.threshold;
        e.search_seconds = now() - start;
        start = now();
    }
    const auto result = nestgrid::isosurface(
        grid, field, request.isovalue, criterion_at(e.threshold), indicator, options, executor);
    e.seconds = now() - start;
    const std::size_t peak = memory::peak() - before;
    e.peak_bytes = peak - std::min(peak, result.surface.memory_bytes());
    e.counts = result.counts;
    e.error_bound = result.error_bound;
    e.stack_bytes = result.stack_bytes;
    if constexpr (Grid::dimension == 3) {
        e.report = nestgrid::surface_report(result.surface);
    } else {
        e.report.vertices = result.surface.vertices.size();
        e.report.triangles = result.surface.simplices.size();
    }
    if (request.keep_surfaces) e.surface = nestgrid::make_poly_data(result.surface);
    return e;
}

template <class Grid, class Field>
void extract_all(const Grid& grid, const Field& field, const ExtractionRequest& request,
                 ExtractionRun& run) {
    using Real = typename Field::value_type;
    run.dimension = Grid::dimension;
    const std::size_t before = memory::current();
    memory::reset_peak();
    const double start = now();
    if (request.progress) request.progress("preroll");
    const nestgrid::TbbExecutor executor(request.threads);
    const ChosenIndicator indicators(
        static_cast<const nestgrid::Hierarchy<Real>&>(nestgrid::erase(grid, field)),
        request.projection, request.lens, executor);
    const nestgrid::HierarchicalIndicator& offsets = indicators.offsets();
    run.preroll_seconds = now() - start;
    run.preroll_peak_bytes = memory::peak() - before;
    run.preroll_kept_bytes = indicators.memory_bytes();
    run.least = offsets.least();
    run.greatest = offsets.greatest();
    const auto draw_all = [&](const auto& criterion_at) {
        for (const std::uint64_t budget : request.budgets) {
            run.surfaces.push_back(
                extract_one(grid, field, criterion_at, offsets, 0, budget, executor, request));
        }
        for (const ThresholdText& t : request.thresholds) {
            run.surfaces.push_back(extract_one(grid, field, criterion_at, offsets,
                                               indicators.threshold(t), 0, executor, request));
        }
    };
    if (!request.box) {
        indicators.with_criteria(draw_all);
        return;
    }
    if (request.progress) request.progress("region");
    const FineBox& box = *request.box;
    const nestgrid::Region region(grid, [&](const nestgrid::Point& x) {
        for (std::size_t d = 0; d < Grid::dimension; ++d) {
            if (x[d] < box.bounds[2 * d] || x[d] > box.bounds[2 * d + 1]) return false;
        }
        return true;
    });
    draw_all([&](double threshold) {
        return nestgrid::fine_inside(region, indicators.chosen(), threshold, box.threshold);
    });
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
