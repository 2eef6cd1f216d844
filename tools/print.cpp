// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "print.hpp"

#include <cstdio>

namespace {

std::string list(std::span<const double> numbers) {
    std::string result;
    for (const double number : numbers) {
        char text[40];
        std::snprintf(text, sizeof(text), "%s%.9g", result.empty() ? "" : " ", number);
        result += text;
    }
    return result;
}

void print_emptiness(const ExtractionRun& run, double isovalue) {
    if (isovalue < run.least || isovalue > run.greatest) {
        std::printf("empty: the isovalue %g is outside the range %g to %g of the data\n", isovalue,
                    run.least, run.greatest);
    }
}

double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / 1048576; }

}  // namespace

void line(const char* name, std::size_t value) { std::printf("%-22s %zu\n", name, value); }
void line(const char* name, double value) { std::printf("%-22s %.6g\n", name, value); }
void line(const char* name, const std::string& value) {
    std::printf("%-22s %s\n", name, value.c_str());
}

std::string caption(const Extraction& e) {
    char text[200];
    std::snprintf(text, sizeof(text), "threshold %.4g\n%zu triangles, %zu open edges", e.threshold,
                  e.report.triangles, e.report.open_edges);
    return text;
}

void print_result(const ExtractionRun& run, double isovalue, const Seconds& seconds) {
    const Extraction& e = run.surfaces.front();
    const nestgrid::SurfaceReport& r = e.report;
    print_emptiness(run, isovalue);
    line("nodes", run.nodes);
    line("leaf_elements", run.leaf_elements);
    line("least_value", run.least);
    line("greatest_value", run.greatest);
    line("isovalue", isovalue);
    line("threshold", e.threshold);
    if (e.budget > 0) {
        line("max_triangles", std::size_t{e.budget});
        line("search_trials", static_cast<std::size_t>(e.search.trials));
        line("search_triangles", std::size_t{e.search.extracted});
        line("search_seconds", e.search_seconds);
    }
    line("inspect_calls", std::size_t{e.counts.calls});
    line("visited", std::size_t{e.counts.visited});
    line("extracted", std::size_t{e.counts.extracted});
    line(run.dimension == 3 ? "triangles" : "segments", r.triangles);
    line("vertices", r.vertices);
    line("error_bound", e.error_bound);
    if (run.dimension == 3) {
        line("open_edges", r.open_edges);
        line("boundary_edges", r.boundary_edges);
        line("nonmanifold_edges", r.nonmanifold_edges);
        line("nonmanifold_vertices", r.nonmanifold_vertices);
        line("components", r.components);
        line("euler_number", static_cast<double>(r.euler));
        line("area", r.area);
        if (r.closed() && r.triangles > 0) line("volume", std::abs(r.volume));
    }
    line("preroll_peak_bytes", run.preroll_peak_bytes);
    line("preroll_kept_bytes", run.preroll_kept_bytes);
    line("traversal_peak_bytes", e.peak_bytes);
    line("traversal_stack_bytes", e.stack_bytes);
    line("read_seconds", seconds.read);
    line("preroll_seconds", run.preroll_seconds);
    line("extract_seconds", e.seconds);
    line("write_seconds", seconds.write);
    if (seconds.draw > 0) line("draw_seconds", seconds.draw);
}

void print_table(const ExtractionRun& run, double isovalue, const Seconds& seconds,
                 const std::optional<Contour>& contour) {
    print_emptiness(run, isovalue);
    line("nodes", run.nodes);
    line("leaf_elements", run.leaf_elements);
    line("read_seconds", seconds.read);
    line("preroll_seconds", run.preroll_seconds);
    line("preroll_peak_bytes", run.preroll_peak_bytes);
    line("preroll_kept_bytes", run.preroll_kept_bytes);
    const bool budgets = run.surfaces.front().budget > 0;
    std::printf("\n");
    if (budgets) std::printf("%13s %6s %6s %8s ", "max_triangles", "trials", "cost", "seconds");
    std::printf("%-16s %10s %10s %10s %11s %10s %8s %9s %9s\n", "threshold", "bound", "triangles",
                "vertices", "visited", "open edges", "boundary", "MiB extra", "seconds");
    for (const Extraction& e : run.surfaces) {
        if (budgets) {
            std::printf("%13llu %6d %6.2f %8.3f ", static_cast<unsigned long long>(e.budget),
                        e.search.trials,
                        static_cast<double>(e.search.extracted) / static_cast<double>(e.budget),
                        e.search_seconds);
        }
        std::printf("%-16.6g %10.4g %10zu %10zu %11llu %10zu %8zu %9.1f %9.3f\n", e.threshold,
                    e.error_bound, e.report.triangles, e.report.vertices,
                    static_cast<unsigned long long>(e.counts.visited), e.report.open_edges,
                    e.report.boundary_edges, mebibytes(e.peak_bytes), e.seconds);
    }
    if (contour) {
        if (budgets) std::printf("%36s ", "");
        std::printf("%-16s %10s %10zu %10zu %11s %10s %8zu %9s %9.3f\n", "VTK FlyingEdges", "",
                    contour->triangles, contour->vertices, "", "", contour->once_edges, "",
                    contour->seconds);
    }
}

void print_times(const ExtractionRun& run, double isovalue) {
    print_emptiness(run, isovalue);
    line("nodes", run.nodes);
    line("leaf_elements", run.leaf_elements);
    line("preroll_seconds", run.preroll_seconds);
    line("preroll_kept_bytes", run.preroll_kept_bytes);
    std::printf("\n%10s %12s %10s %10s %10s %11s %10s %9s\n", "time", "threshold", "bound",
                "triangles", "vertices", "visited", "open edges", "seconds");
    for (const Extraction& e : run.surfaces) {
        std::printf("%10.6g %12.6g %10.4g %10zu %10zu %11llu %10zu %9.3f\n", *e.time, e.threshold,
                    e.error_bound, e.report.triangles, e.report.vertices,
                    static_cast<unsigned long long>(e.counts.visited), e.report.open_edges,
                    e.seconds);
    }
}

void print_info(const HierarchyInfo& info) {
    line("family", info.family);
    line("dimension", static_cast<std::size_t>(info.dimension));
    line("coarse_elements", info.coarse_elements);
    line("leaf_elements", info.leaves);
    for (const auto& [shape, count] : info.shapes) {
        line(("leaf_" + std::string(nestgrid::topology(shape).name)).c_str(), count);
    }
    line("nodes", info.nodes);
    line("hanging_nodes", info.hanging);
    line("levels", static_cast<std::size_t>(info.levels));
    line("measure", info.measure);
    line("bytes_per_leaf", static_cast<double>(info.bytes) / static_cast<double>(info.leaves));
    if (info.times != std::vector<double>{0}) {
        line("frames", info.times.size());
        line("times", list(info.times));
    }
    for (const FieldInfo& f : info.fields) {
        line("field", f.name);
        line("least_value", f.least);
        line("greatest_value", f.greatest);
        if (!f.step) continue;
        if (*f.step == 0) line("encoded", std::string("bit for bit"));
        if (*f.step > 0) line("encoded_within", *f.step / 2);
        line("bytes_per_value",
             static_cast<double>(f.bytes) / static_cast<double>(info.nodes * info.times.size()));
    }
}

void print_info(const Volume& volume) {
    const nestgrid::LatticeBisection<3> grid(volume.geometry);
    const auto& g = volume.geometry;
    const auto [least, greatest] = with_samples(volume, [](auto samples) {
        const auto [lo, hi] = std::minmax_element(samples.begin(), samples.end());
        return std::pair(static_cast<double>(*lo), static_cast<double>(*hi));
    });
    line("samples", std::to_string(g.samples[0]) + " " + std::to_string(g.samples[1]) + " " +
                        std::to_string(g.samples[2]));
    line("type", volume.type);
    line("spacing", list(g.spacing));
    line("origin", list(g.origin));
    for (std::size_t d = 0; d < 3; ++d) {
        const nestgrid::Point axis{g.direction[0][d], g.direction[1][d], g.direction[2][d]};
        line(d == 0 ? "axis_x" : d == 1 ? "axis_y" : "axis_z", list(axis));
    }
    line("least_value", least);
    line("greatest_value", greatest);
    line("nodes", volume.sample_count());
    line("padded_nodes", grid.node_count());
    line("block_cells", std::size_t{1} << static_cast<unsigned>(grid.block_levels()));
    line("coarse_elements", grid.coarse_count());
    line("levels", 3 * static_cast<std::size_t>(grid.block_levels()) + 1);
    line("leaf_elements", leaf_count(grid));
}
