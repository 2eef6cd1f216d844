// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/high_order.hpp>
#include <nestgrid/algorithms/probe_line.hpp>
#include <nestgrid/error.hpp>

#include "drawing/moments.hpp"
#include "input/input_file.hpp"
#include "input/standard_input.hpp"
#include "output/print.hpp"
#include "output/surface_file.hpp"
#include "output/text_file.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::InvalidInput;
using nestgrid::Point;

struct ProbeArguments {
    Input input;
    std::vector<double> line;
    int count = 100;
    fs::path points;
    std::vector<std::string> threshold;  ///< at most one
    nestgrid::Projection projection;
    LensText lens;
    TimeOptions time;
    fs::path output;
};

/// Three numbers between commas, or nothing.
std::optional<Point> parse_point(const std::string& text) {
    Point x{};
    const char* at = text.c_str();
    for (std::size_t d = 0; d < 3; ++d) {
        char* end = nullptr;
        x[d] = std::strtod(at, &end);
        if (end == at || !std::isfinite(x[d])) return std::nullopt;
        while (*end == ' ' || *end == '\r') ++end;
        if (*end != (d < 2 ? ',' : '\0')) return std::nullopt;
        at = end + 1;
    }
    return x;
}

/// Reads points, one a line, below a line of names that may be missing.
std::vector<Point> read_points(const fs::path& path) {
    require_file(path);
    std::ifstream file(path);
    std::vector<Point> points;
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        if (line.find_first_not_of(" \r") == std::string::npos) continue;
        const std::optional<Point> x = parse_point(line);
        if (x) {
            points.push_back(*x);
        } else if (number > 1) {
            throw InvalidInput(path.string() + ", line " + std::to_string(number) +
                               ": not three finite numbers between commas");
        }
    }
    if (points.empty()) throw InvalidInput(path.string() + " has no points");
    return points;
}

/// Values within the error that nobody asks for.
nestgrid::ProbeResult probe_within(const nestgrid::HighOrder& data,
                                   const std::vector<Point>& points) {
    const nestgrid::VirtualRefinement fine(data, {.tolerance = nestgrid::default_error(data)});
    return nestgrid::probe(fine, points, under(fine.criterion(), fine.bounds()));
}

/// Takes points down at one moment.
/// \param threshold at most one; default: 0, or with a lens whatever the data are
nestgrid::ProbeResult probe_at(const Moment& moment, const std::vector<Point>& points,
                               std::vector<ThresholdText> threshold, bool with_lens) {
    const bool exactly = !with_lens && (threshold.empty() || threshold.front().number == 0);
    if (const std::shared_ptr<const nestgrid::HighOrder> data = moment.high_order()) {
        if (exactly) return probe_within(*data, points);
        throw InvalidInput("the field has degree " + std::to_string(data->greatest_degree()) +
                           ": neither a threshold nor a lens leaves out a part of it");
    }
    return moment.visit([&](const auto& hierarchy) {
        if (exactly) return nestgrid::probe(hierarchy, points);
        set_default_threshold(threshold, with_lens);
        const nestgrid::Criteria& criteria = moment.criteria();
        return nestgrid::probe(
            hierarchy, points,
            under(criteria.at(moment.threshold(threshold.front())), criteria.bounds()));
    });
}

/// Appends a row for each point.
/// \param time the first column, where it is one
void append_rows(const nestgrid::ProbeResult& result, const std::vector<Point>& points,
                 const std::optional<double>& time, std::ostream& out) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [x, y, z] = points[i];
        if (time) out << *time << ',';
        out << x << ',' << y << ',' << z << ',';
        if (result.found(i)) out << result.values[i * result.components] << ',' << result.level[i];
        if (!result.found(i)) out << ',';
        out << '\n';
    }
}

/// Adds to a report the rows that append_rows() writes.
void add_rows(const nestgrid::ProbeResult& result, const std::vector<Point>& points,
              const std::optional<double>& time, const std::string& name, Report& report) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        Row row;
        if (time) row.add("time", *time);
        row.add("x", points[i][0]).add("y", points[i][1]).add("z", points[i][2]);
        if (result.found(i)) {
            row.add(name, double{result.values[i * result.components]});
            row.add("level", static_cast<std::uint64_t>(result.level[i]));
        }
        report.add_row("points", row);
    }
}

/// Takes the points down at each moment: as .csv, or into the report where that is JSON and no file
/// is asked for.
void probe_all(ProbeArguments& o, const std::vector<Point>& points, Report& report) {
    std::vector<ThresholdText> threshold;
    for (const std::string& text : o.threshold) threshold.push_back(parse_threshold(text));
    o.projection.lens = parse(o.lens);
    const fs::path path = o.input.path;
    const InputField field = read_field(o.input, o.time.more, o.time.times, o.time.wanted());
    const Moments moments(field, o.time, path, o.projection, {}, 0);
    const bool several = o.time.frames.has_value();
    const bool as_rows = report.json() && o.output.empty();
    std::ostringstream out;
    out.precision(17);
    out << (several ? "time," : "") << "x,y,z," << field.name << ",level\n";
    std::uint64_t count = 0;
    moments.for_each([&](const Moment& moment) {
        const auto result = probe_at(moment, points, threshold, o.projection.lens.has_value());
        const std::optional<double> time = several ? moment.time() : std::nullopt;
        count += points.size();
        if (as_rows) {
            add_rows(result, points, time, field.name, report);
        } else {
            append_rows(result, points, time, out);
        }
    });
    if (report.json()) report_field(field.name, field.length_unit, report);
    const bool prints_values = o.output.empty() && !as_rows;
    if (!field.note.empty() && !prints_values) report.say(field.note);
    if (as_rows) return;
    if (o.output.empty()) {
        if (!field.note.empty()) std::fprintf(stderr, "nestgrid: %s\n", field.note.c_str());
        std::fputs(out.str().c_str(), stdout);
    } else {
        write_text(out.str(), o.output);
        report.wrote(o.output, {{"points", count}});
    }
}

void check(const ProbeArguments& o) {
    if (o.line.empty() == o.points.empty()) {
        throw InvalidInput("a probe needs either --line or --points");
    }
    if (o.line.empty()) refuse_options(*o.input.command, {"--count"}, "is for --line");
    if (o.count < 2) throw InvalidInput("--count is below 2");
    if (!o.output.empty() && !is_standard_stream(o.output)) check_writable(o.output);
    for (const std::string& text : o.threshold) parse_threshold(text);
    if (o.threshold.empty()) require_threshold(*o.input.command);
    ::check(o.projection);
    check(o.time);
}

void run_probe(ProbeArguments& o, Report& report) {
    check(o);
    if (is_standard_stream(o.output)) o.output.clear();
    std::vector<Point> points;
    if (o.line.empty()) {
        points = read_points(o.points);
    } else {
        points = nestgrid::detail::make_line({o.line[0], o.line[1], o.line[2]},
                                             {o.line[3], o.line[4], o.line[5]},
                                             static_cast<std::size_t>(o.count))
                     .points;
    }
    probe_all(o, points, report);
}

Command add_probe(CLI::App& program) {
    auto o = std::make_shared<ProbeArguments>();
    CLI::App* probe = program.add_subcommand("probe", "print values at points, as .csv");
    probe->footer(
        "Examples:\n"
        "  nestgrid probe head.nii.gz --line 0,9,9,9,9,9 --count 200 -o line.csv\n");
    add_input(*probe, o->input);
    probe->add_option("--line", o->line, "points between two ends, --count of them")
        ->type_name("X,Y,Z,X,Y,Z")
        ->delimiter(',')
        ->expected(6);
    probe->add_option("--count", o->count, "how many points on the line [100]")->type_name("COUNT");
    probe->add_option("--points", o->points, "or the points of a file, x,y,z on each line")
        ->type_name("FILE");
    probe
        ->add_option("--threshold", o->threshold,
                     "leave out detail up to this, in units of the data or in percent of their "
                     "range [0]")
        ->type_name("NUMBER[%]")
        ->expected(1);
    probe
        ->add_option("-o,--output", o->output,
                     "write .csv [standard output]; points outside the grid have no value")
        ->type_name("FILE");
    add_projection_options(*probe, o->projection, false);
    add_time_options(*probe, o->time);
    probe->get_option("--frames")
        ->description("so many times from the first frame to the last, one after the other");
    add_lens_options(*probe, o->lens);
    add_read_options(*probe, o->input);
    return {probe, [o](Report& report) { run_probe(*o, report); }};
}

const RegisteredCommand probe_command(70, add_probe);

}  // namespace
