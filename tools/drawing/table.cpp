// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "joined.hpp"
#include "output/print.hpp"

namespace {

/// Whether an error was asked for and is kept, there and back.
bool is_promised(const Drawn& d, const DrawingRequest& request) {
    return request.in_one_colour() && d.threshold > 0 && std::isfinite(d.result.surface_error);
}

/// The beginning of a row about one surface: its part, its time between frames, its isovalue, its
/// number of triangles, its threshold.
Row begin_row(const Drawn& d) {
    Row row;
    if (d.label) row.add("label", *d.label);
    if (d.time) row.add("time", *d.time);
    if (d.isovalue) row.add("isovalue", *d.isovalue);
    if (d.search.max_triangles > 0) row.add("max_triangles", d.search.max_triangles);
    return row.add("threshold", d.threshold);
}

/// How many of the first cells of such a row tell it from the others.
std::size_t keys_of(const Drawn& d) { return begin_row(d).cells().size(); }

/// The bound of a result, or nothing where it promises no more than any drawing keeps.
Cell bound_of(const nestgrid::ErrorBounds& bounds) {
    if (bounds.bound_says_nothing()) return {};
    return bounds.error_bound;
}

void add_measured(const nestgrid::MeasuredError& measured, double seconds, Row& row) {
    row.add("measured_error", measured.value.greatest).add("measured_rms", measured.value.rms);
    row.add("distance", measured.distance.greatest).add("distance_rms", measured.distance.rms);
    row.add("distance_back", measured.back.greatest).add("distance_back_rms", measured.back.rms);
    row.add("measure_seconds", seconds);
}

/// What everybody wants to know of a surface comes first.
Row row_of(const Drawn& d, const DrawnField& field, const DrawingRequest& request) {
    const nestgrid::SurfaceReport& r = d.report;
    const bool alone = request.in_one_colour();
    const bool triangles = !alone || field.dimension == 3;
    Row row = begin_row(d);
    row.add(triangles ? "triangles" : "segments", r.triangles).add("vertices", r.vertices);
    row.add("error_bound", bound_of(d.result));
    if (d.curved) row.add("position_bound", d.result.position_bound);
    if (is_promised(d, request)) row.add("surface_error", d.result.surface_error);
    if (triangles) row.add("open_edges", r.open_edges).add("area", r.area);
    const bool encloses = r.closed() && r.triangles > 0;
    if (alone && triangles) row.add("volume", encloses ? Cell(std::abs(r.volume)) : Cell());
    const auto of_walk = [&](auto cost) { return d.shares_walk ? Cell() : Cell(cost); };
    row.add("seconds", of_walk(d.seconds));
    if (request.has_two_surfaces()) {
        row.add("isosurface_triangles", d.isosurface_report.triangles);
        row.add("isosurface_open_edges", d.isosurface_report.open_edges);
        row.add("isosurface_area", d.isosurface_report.area);
    }
    if (d.far_points) row.add("far_points", *d.far_points);
    if (d.collapsed) {
        row.add("collapse_seconds", d.collapse_seconds);
        row.add("collapses", std::uint64_t{d.collapsed->collapses});
        row.add("exceeding", std::uint64_t{d.collapsed->exceeding});
    }
    if (d.measured) add_measured(*d.measured, d.measure_seconds, row);
    if (triangles) row.add("boundary_edges", r.boundary_edges);
    if (alone && triangles) {
        row.add("components", r.components).add("euler_number", static_cast<double>(r.euler));
        row.add("nonmanifold_edges", r.nonmanifold_edges);
        row.add("nonmanifold_vertices", r.nonmanifold_vertices);
    }
    const nestgrid::TraversalCounts& counts = d.result.counts;
    row.add("inspect_calls", of_walk(counts.calls)).add("visited", of_walk(counts.visited));
    row.add("extracted", of_walk(counts.extracted));
    if (d.search.max_triangles > 0) {
        row.add("search_trials", static_cast<std::uint64_t>(d.search.trials));
        row.add("search_triangles", d.search.extracted).add("search_seconds", d.search_seconds);
    }
    row.add("peak_bytes", of_walk(d.peak_bytes));
    return row.add("stack_bytes", of_walk(d.result.stack_bytes));
}

/// One row for each value: how many lines have it, and their lengths together.
void report_isolines(const Drawn& d, const std::vector<double>& values, Report& report) {
    for (const double value : values) {
        std::uint64_t rings = 0;
        std::uint64_t open = 0;
        double length = 0;
        for (std::size_t i = 0; i < d.isolines.count(); ++i) {
            if (d.isolines.value[i] != value) continue;
            ++(d.isolines.closed(i) ? rings : open);
            length += d.isolines.length(i);
        }
        Row row = begin_row(d);
        row.add("isoline", value).add("rings", rings).add("open_lines", open);
        report.add_row("isolines", row.add("length", length), keys_of(d) + 1);
    }
}

void report_facts(const DrawnField& field, const DrawingRequest& request, Report& report) {
    report_field(field.name, field.length_unit, report);
    report_range({field.least, field.greatest}, report);
    if (request.has_isovalue() && !request.has_several_isovalues()) {
        report.add("isovalue", request.isovalues.front());
    }
    if (request.upper) report.add("upper_isovalue", *request.upper);
    report.add("nodes", std::uint64_t{field.nodes});
    report.add("leaf_elements", std::uint64_t{field.leaf_elements});
    if (field.preroll_seconds > 0) {
        report.add("preroll_peak_bytes", std::uint64_t{field.preroll_peak_bytes});
        report.add("preroll_kept_bytes", std::uint64_t{field.preroll_kept_bytes});
        report.add("preroll_seconds", field.preroll_seconds);
    }
    report.add("read_seconds", field.read_seconds);
    if (field.write_seconds > 0) report.add("write_seconds", field.write_seconds);
    if (field.picture_seconds > 0) report.add("draw_seconds", field.picture_seconds);
}

/// Sums of several surfaces.
void say_sum(const DrawnField& field, const std::string& what, Report& report) {
    if (field.surfaces.size() < 2) return;
    std::uint64_t simplices = 0;
    double seconds = 0;
    for (const Drawn& d : field.surfaces) {
        simplices += d.report.triangles + d.isosurface_report.triangles;
        seconds += d.seconds;
    }
    std::array<char, 40> time{};
    std::snprintf(time.data(), time.size(), "%.3g", seconds);
    report.say("in all: " + grouped(field.surfaces.size()) + " surfaces, " + grouped(simplices) +
               " " + what + ", " + time.data() + " seconds");
}

/// Why there are fewer triangles than asked for, as a sentence about the first of several.
void say_why_not_filled(const std::vector<Drawn>& surfaces, Report& report) {
    std::vector<std::string> reasons;
    for (const Drawn& d : surfaces) {
        const std::string reason = d.search.max_triangles > 0 ? d.search.reason() : std::string();
        if (!reason.empty()) reasons.push_back(reason);
    }
    if (reasons.empty()) return;
    const std::size_t others = reasons.size() - 1;
    report.say(others == 0
                   ? reasons.front()
                   : reasons.front() + " (" + grouped(others) + " more surfaces have less)");
}

void say_what_is_promised(const Drawn& d, Report& report) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  d.collapsed ? "surface within %.4g of the isovalue, and data that differ from it "
                                "by more than the error lie on their side"
                              : "surface within %.4g of the isovalue, and the whole surface of the "
                                "data within it of what is drawn",
                  d.result.surface_error);
    report.say(text.data());
}

/// How a field of higher degree was drawn.
void say_how_finely(const Drawn& d, Report& report) {
    std::array<char, 160> text{};
    if (std::isinf(d.threshold)) {
        std::snprintf(text.data(), text.size(),
                      "polynomials of degree %d, drawn as finely as the lens asks", d.degree);
    } else {
        std::snprintf(
            text.data(), text.size(), "drawn within %.4g of polynomials of degree %d%s",
            d.threshold, d.degree,
            d.by_default ? ", about a thousandth of their range: --error chooses another" : "");
    }
    report.say(text.data());
    if (d.curved) {
        std::snprintf(
            text.data(), text.size(),
            "no point is farther than %.4g from its place in the curved cells, in the unit "
            "of the grid",
            d.result.position_bound);
        report.say(text.data());
    }
    if (d.result.counts.limited == 0) return;
    report.say(grouped(d.result.counts.limited) +
               " elements were halved as often as they may be, and are further off: the error "
               "bound counts them");
}

}  // namespace

std::string why_empty(const DrawingRequest& request, double least, double greatest) {
    std::vector<double> numbers{least, greatest};
    numbers.insert(numbers.end(), request.isovalues.begin(), request.isovalues.end());
    if (request.upper) numbers.push_back(*request.upper);
    const auto texts = distinct_texts(numbers);
    const std::string range = "the range " + texts[0] + " to " + texts[1] + " of the data";
    if (least == greatest) return "the data have the value " + texts[0] + " everywhere";
    if (request.upper) {
        const double low = request.isovalues.front();
        if (low<least&& * request.upper> greatest) return "the band holds " + range;
        if (*request.upper >= least && low <= greatest) return "";
        return "the band " + texts[2] + " to " + texts[3] + " is outside " + range;
    }
    std::vector<std::string> outside;
    for (std::size_t i = 2; i < numbers.size(); ++i) {
        if (numbers[i] < least || numbers[i] > greatest) outside.push_back(texts[i]);
    }
    if (outside.empty()) return "";
    const bool one = outside.size() == 1;
    return (one ? "the isovalue " : "the isovalues ") + joined(outside, "and") +
           (one ? " is" : " are") + " outside " + range;
}

void report_drawn(const DrawnField& field, const DrawingRequest& request, Report& report) {
    report_facts(field, request, report);
    for (const Drawn& d : field.surfaces) {
        report.add_row("surfaces", row_of(d, field, request), keys_of(d));
        report_isolines(d, field.values, report);
    }
    const bool segments = request.in_one_colour() && field.dimension == 2;
    say_sum(field, segments ? "segments" : "triangles", report);
    say_why_not_filled(field.surfaces, report);
    if (field.surfaces.size() == 1 && is_promised(field.surfaces.front(), request)) {
        say_what_is_promised(field.surfaces.front(), report);
    }
    for (const Drawn& d : field.surfaces) {
        if (d.degree > 1 || d.curved) say_how_finely(d, report);
    }
    if (std::ranges::any_of(field.surfaces,
                            [](const Drawn& d) { return d.result.bound_says_nothing(); })) {
        report.say("the error bound says nothing: it is no less than the range of the data allows");
    }
    const bool empty = std::ranges::all_of(field.surfaces, [&](const Drawn& d) {
        return (request.has_two_surfaces() ? d.isosurface_report : d.report).triangles == 0;
    });
    if (field.outside.empty()) return;
    if (empty) {
        const std::string what = request.has_several_isovalues() ? "the isosurfaces are"
                                 : request.upper                 ? "the surface is"
                                                                 : "the isosurface is";
        report.say(what + " empty: " + field.outside);
    } else if (request.has_several_isovalues()) {
        report.say(field.outside);
    }
}
