// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "output/print.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "drawing/first_isovalue.hpp"

namespace {

/// Whether an error was asked for and is kept.
bool is_promised(const Extraction& e) { return e.threshold > 0 && std::isfinite(e.surface_error); }

void say_what_is_promised(const ExtractionRun& run, Report& report) {
    if (run.surfaces.size() != 1 || !is_promised(run.surfaces.front())) return;
    const Extraction& e = run.surfaces.front();
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  e.collapsed ? "surface within %.4g of the isovalue, and data that differ from it "
                                "by more than the error lie on their side"
                              : "surface within %.4g of the isovalue, and the whole surface of the "
                                "data within it of what is drawn",
                  e.surface_error);
    report.say(text.data());
}

/// What everybody wants to know of a surface comes first.
Row row_of(const Extraction& e, bool in_space) {
    const nestgrid::SurfaceReport& r = e.report;
    Row row;
    if (e.label) row.add("label", *e.label);
    row.append(begin_row(e.time, e.search.max_triangles, e.threshold));
    row.add(in_space ? "triangles" : "segments", r.triangles).add("vertices", r.vertices);
    row.add("error_bound", bound_of(e.bounds));
    if (is_promised(e)) row.add("surface_error", e.surface_error);
    if (in_space) row.add("open_edges", r.open_edges).add("area", r.area);
    const bool encloses = r.closed() && r.triangles > 0;
    if (in_space) row.add("volume", encloses ? Cell(std::abs(r.volume)) : Cell());
    row.add("seconds", e.seconds);
    if (e.far_points) row.add("far_points", *e.far_points);
    if (e.collapsed) {
        row.add("collapse_seconds", e.collapse_seconds);
        row.add("collapses", std::uint64_t{e.collapsed->collapses});
        row.add("exceeding", std::uint64_t{e.collapsed->exceeding});
    }
    if (e.measured) {
        row.add("measured_error", e.measured->value.greatest);
        row.add("measured_rms", e.measured->value.rms);
        row.add("distance", e.measured->distance.greatest);
        row.add("distance_rms", e.measured->distance.rms);
        row.add("distance_back", e.measured->back.greatest);
        row.add("distance_back_rms", e.measured->back.rms);
        row.add("measure_seconds", e.measure_seconds);
    }
    if (in_space) {
        row.add("boundary_edges", r.boundary_edges).add("components", r.components);
        row.add("euler_number", static_cast<double>(r.euler));
        row.add("nonmanifold_edges", r.nonmanifold_edges);
        row.add("nonmanifold_vertices", r.nonmanifold_vertices);
    }
    row.add("inspect_calls", e.counts.calls).add("visited", e.counts.visited);
    row.add("extracted", e.counts.extracted);
    if (e.search.max_triangles > 0) {
        row.add("search_trials", static_cast<std::uint64_t>(e.search.trials));
        row.add("search_triangles", e.search.extracted).add("search_seconds", e.search_seconds);
    }
    return row.add("peak_bytes", e.peak_bytes).add("stack_bytes", e.stack_bytes);
}

Row row_of(const Contour& contour) {
    Row row;
    row.add("contour", "vtkFlyingEdges3D").add("triangles", contour.triangles);
    row.add("vertices", contour.vertices).add("boundary_edges", contour.once_edges);
    return row.add("nonmanifold_edges", contour.nonmanifold_edges).add("seconds", contour.seconds);
}

/// Appends the facts about a lattice of samples.
template <int dimension>
void report_lattice(const nestgrid::LatticeGeometry<dimension>& geometry, Report& report) {
    const nestgrid::LatticeBisection<dimension> grid(geometry);
    constexpr auto axes = std::array{"axis_x", "axis_y", "axis_z"};
    const auto levels = static_cast<std::uint64_t>(grid.block_levels());
    report.add("spacing", std::vector<double>(geometry.spacing.begin(), geometry.spacing.end()));
    report.add("origin", std::vector<double>(geometry.origin.begin(), geometry.origin.end()));
    for (std::size_t d = 0; d < dimension; ++d) {
        std::vector<double> axis;
        for (std::size_t r = 0; r < dimension; ++r) axis.push_back(geometry.direction[r][d]);
        report.add(axes[d], axis);
    }
    report.add("padded_nodes", std::uint64_t{grid.node_count()});
    report.add("block_cells", std::uint64_t{1} << levels);
    report.add("coarse_elements", std::uint64_t{grid.coarse_count()});
    report.add("levels", dimension * levels + 1);
}

/// So many digits, at least six, that four tell values between these apart.
int digits_between(double least, double greatest) {
    const double size = std::max(std::abs(least), std::abs(greatest));
    if (!(greatest > least) || !std::isfinite(greatest - least)) return 6;
    return std::clamp(4 + static_cast<int>(std::ceil(std::log10(size / (greatest - least)))), 6,
                      17);
}

Row row_of(const FieldInfo& f, const HierarchyInfo& info) {
    Row row;
    row.add("field", f.name).add("least_value", f.least).add("greatest_value", f.greatest);
    if (!f.step) return row;
    if (*f.step == 0) row.add("encoded", "exactly");
    if (*f.step > 0) row.add("encoded_within", *f.step / 2);
    const auto values = static_cast<double>(info.nodes * info.times.size());
    return row.add("bytes_per_value", static_cast<double>(f.bytes) / values);
}

}  // namespace

void report_range(std::pair<double, double> range, Report& report) {
    const int digits = digits_between(range.first, range.second);
    report.add("least_value", Digits{range.first, digits});
    report.add("greatest_value", Digits{range.second, digits});
}

std::string caption(const Extraction& e) {
    char text[200];
    std::snprintf(text, sizeof(text), "threshold %.4g\n%zu triangles, %zu open edges", e.threshold,
                  e.report.triangles, e.report.open_edges);
    if (!e.label) return text;
    std::array<char, 40> label{};
    std::snprintf(label.data(), label.size(), "label %.10g, ", *e.label);
    return std::string(label.data()) + text;
}

Row begin_row(const std::optional<double>& time, std::uint64_t budget, double threshold) {
    Row row;
    if (time) row.add("time", *time);
    if (budget > 0) row.add("max_triangles", budget);
    return row.add("threshold", threshold);
}

Cell bound_of(const nestgrid::ErrorBounds& bounds) {
    if (bounds.bound_says_nothing()) return {};
    return bounds.error_bound;
}

std::string outside_range(double isovalue, double least, double greatest) {
    const auto texts = distinct_texts({isovalue, least, greatest});
    if (least == greatest) return "the data have the value " + texts[1] + " everywhere";
    if (isovalue >= least && isovalue <= greatest) return "";
    return "the isovalue " + texts[0] + " is outside the range " + texts[1] + " to " + texts[2] +
           " of the data";
}

void say_nothing_bounded(Report& report) {
    report.say("the error bound says nothing: it is no less than the range of the data allows");
}

void say_why_not_filled(const std::vector<nestgrid::TriangleBudget>& searches, Report& report) {
    std::vector<std::string> reasons;
    for (const nestgrid::TriangleBudget& search : searches) {
        const std::string reason = search.max_triangles > 0 ? search.reason() : std::string();
        if (!reason.empty()) reasons.push_back(reason);
    }
    if (reasons.empty()) return;
    const std::size_t others = reasons.size() - 1;
    report.say(others == 0
                   ? reasons.front()
                   : reasons.front() + " (" + grouped(others) + " more surfaces have less)");
}

std::size_t keys_of(const std::optional<double>& time, std::uint64_t budget) {
    return 1 + (time ? 1 : 0) + (budget > 0 ? 1 : 0);
}

void report_sum(std::size_t surfaces, std::uint64_t simplices, const std::string& what,
                double seconds, Report& report) {
    if (surfaces < 2) return;
    std::array<char, 40> time{};
    std::snprintf(time.data(), time.size(), "%.3g", seconds);
    report.say("in all: " + grouped(surfaces) + " surfaces, " + grouped(simplices) + " " + what +
               ", " + time.data() + " seconds");
}

void report_field(const std::string& name, const std::string& unit, Report& report) {
    report.add("field", name);
    if (!unit.empty()) report.add("length_unit", unit);
}

void report_surfaces(const ExtractionRun& run, double isovalue, const Seconds& seconds,
                     const std::optional<Contour>& contour, Report& report) {
    const bool in_space = run.dimension == 3;
    report_range({run.least, run.greatest}, report);
    report.add("isovalue", isovalue);
    report.add("nodes", std::uint64_t{run.nodes});
    report.add("leaf_elements", std::uint64_t{run.leaf_elements});
    report.add("preroll_peak_bytes", std::uint64_t{run.preroll_peak_bytes});
    report.add("preroll_kept_bytes", std::uint64_t{run.preroll_kept_bytes});
    report.add("preroll_seconds", run.preroll_seconds);
    report.add("read_seconds", seconds.read);
    if (seconds.write > 0) report.add("write_seconds", seconds.write);
    if (seconds.draw > 0) report.add("draw_seconds", seconds.draw);
    std::uint64_t simplices = 0;
    double drawing = 0;
    std::vector<nestgrid::TriangleBudget> searches;
    for (const Extraction& e : run.surfaces) {
        searches.push_back(e.search);
        const std::size_t keys = keys_of(e.time, e.search.max_triangles) + (e.label ? 1 : 0);
        report.add_row("surfaces", row_of(e, in_space), keys);
        simplices += e.report.triangles;
        drawing += e.seconds;
    }
    if (contour) report.add_row("vtk", row_of(*contour));
    report_sum(run.surfaces.size(), simplices, in_space ? "triangles" : "segments", drawing,
               report);
    say_why_not_filled(searches, report);
    say_what_is_promised(run, report);
    if (std::ranges::any_of(run.surfaces,
                            [](const Extraction& e) { return e.bounds.bound_says_nothing(); })) {
        say_nothing_bounded(report);
    }
    const std::string reason = outside_range(isovalue, run.least, run.greatest);
    if (simplices == 0 && !reason.empty()) report.say("empty: " + reason);
}

void report_info(const HierarchyInfo& info, Report& report) {
    report.add("family", info.family);
    report.add("dimension", static_cast<std::uint64_t>(info.dimension));
    report.add("coarse_elements", std::uint64_t{info.coarse_elements});
    report.add("leaf_elements", std::uint64_t{info.leaves});
    for (const auto& [shape, count] : info.shapes) {
        report.add("leaf_" + std::string(nestgrid::topology(shape).name), std::uint64_t{count});
    }
    report.add("nodes", std::uint64_t{info.nodes});
    report.add("hanging_nodes", std::uint64_t{info.hanging});
    report.add("levels", static_cast<std::uint64_t>(info.levels));
    report.add("measure", info.measure);
    report.add("bytes_per_leaf",
               static_cast<double>(info.bytes) / static_cast<double>(info.leaves));
    if (info.times != std::vector<double>{0}) {
        report.add("frames", std::uint64_t{info.times.size()});
        report.add("times", info.times);
    }
    for (const FieldInfo& f : info.fields) report.add_row("fields", row_of(f, info));
}

void report_info(const Volume& volume, Report& report) {
    const auto& samples = volume.geometry.samples;
    const std::size_t axes = volume.is_plane() ? 2 : 3;
    report_field(volume.name.empty() ? "value" : volume.name, volume.length_unit, report);
    if (!volume.space.empty()) {
        const std::string& unit = volume.length_unit;
        report.add("space", volume.space + (unit.empty() ? "" : " (" + unit + ")"));
    }
    report.add("samples", std::vector<double>(samples.begin(),
                                              samples.begin() + static_cast<std::ptrdiff_t>(axes)));
    report.add("type", volume.type);
    if (volume.missing > 0) report.add("missing", std::uint64_t{volume.missing});
    report_range(with_samples(volume,
                              [](auto values) {
                                  const ValueSample sample = value_sample_of(
                                      values.size(), [&](std::size_t i) { return values[i]; });
                                  return std::pair(sample.least, sample.greatest);
                              }),
                 report);
    report.add("nodes", std::uint64_t{volume.sample_count()});
    report.add("leaf_elements", std::uint64_t{leaf_count(volume.geometry)});
    if (volume.is_plane()) {
        report_lattice<2>(plane_of(volume.geometry), report);
    } else {
        report_lattice<3>(volume.geometry, report);
    }
    if (!volume.note.empty()) report.say(volume.note);
}
