// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nestgrid/algorithms/probe_line.hpp>
#include <nestgrid/error.hpp>

#include "moments.hpp"
#include "surface_file.hpp"
#include "text_file.hpp"

namespace {

namespace fs = std::filesystem;
using nestgrid::InvalidInput;
using nestgrid::IoError;
using nestgrid::Point;

struct Options {
    Input input;
    std::vector<double> line;
    int count = 100;
    fs::path points;
    std::vector<std::string> threshold;  ///< at most one
    ProjectionChoice projection;
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
    std::ifstream file(path);
    if (!file) throw IoError(path.string() + " cannot be opened");
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

/// Takes points down at one moment.
/// \param threshold at most one; default: 0, or with a lens whatever the data are
nestgrid::ProbeResult probe_at(const Moment& moment, const std::vector<Point>& points,
                               std::vector<ThresholdText> threshold, bool with_lens) {
    const bool exactly = !with_lens && (threshold.empty() || threshold.front().number == 0);
    return moment.visit([&](const auto& hierarchy) {
        if (exactly) return nestgrid::probe(hierarchy, points);
        set_default_threshold(threshold, with_lens);
        const ChosenIndicator& indicators = moment.indicators();
        nestgrid::ProbeResult result;
        indicators.with_criteria([&](const auto& criterion_at) {
            result = nestgrid::probe(hierarchy, points,
                                     criterion_at(indicators.threshold(threshold.front())),
                                     indicators.bounds());
        });
        return result;
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

/// The values at the points; with --frames at each time, in front of which it stands.
std::string table(Options& o, const std::vector<Point>& points) {
    std::vector<ThresholdText> threshold;
    for (const std::string& text : o.threshold) threshold.push_back(parse_threshold(text));
    const std::optional<LensRequest> lens = parse(o.lens);
    const fs::path path = o.input.path;
    const InputField field = read_field(o.input, o.time.more, o.time.times);
    const Moments moments(field, o.time, path, o.projection, lens, 0);
    std::ostringstream out;
    out.precision(17);
    const bool several = o.time.frames.has_value();
    out << (several ? "time," : "") << "x,y,z," << field.name << ",level\n";
    moments.for_each([&](const Moment& moment) {
        append_rows(probe_at(moment, points, threshold, lens.has_value()), points,
                    several ? moment.time() : std::nullopt, out);
    });
    return out.str();
}

void run_probe(Options& o) {
    if (o.line.empty() == o.points.empty()) {
        throw InvalidInput("a probe needs either --line or --points");
    }
    if (o.count < 2) throw InvalidInput("--count is below 2");
    if (!o.output.empty()) check_writable(o.output);
    for (const std::string& text : o.threshold) parse_threshold(text);
    check(o.projection);
    check(o.time, o.input.path);
    std::vector<Point> points;
    if (o.line.empty()) {
        points = read_points(o.points);
    } else {
        points = nestgrid::detail::make_line({o.line[0], o.line[1], o.line[2]},
                                             {o.line[3], o.line[4], o.line[5]},
                                             static_cast<std::size_t>(o.count))
                     .points;
    }
    const std::string text = table(o, points);
    if (o.output.empty()) {
        std::fputs(text.c_str(), stdout);
    } else {
        write_text(text, o.output);
    }
}

}  // namespace

Command add_probe(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* probe = program.add_subcommand("probe", "print values at points, as .csv");
    add_input_options(*probe, o->input);
    probe->add_option("--line", o->line, "points between the ends x,y,z,x,y,z, --count of them")
        ->delimiter(',')
        ->expected(6);
    probe->add_option("--count", o->count, "how many points on the line")->capture_default_str();
    probe->add_option("--points", o->points, "a file with x,y,z on each line, .csv");
    probe
        ->add_option("--threshold", o->threshold,
                     "detail up to this is projected away: in units of --indicator, or in percent "
                     "of the range of the data (2%)")
        ->expected(1);
    add_projection_options(*probe, o->projection);
    add_lens_options(*probe, o->lens);
    add_time_options(*probe, o->time);
    probe->get_option("--frames")
        ->description("so many times from the first frame to the last, one after the other");
    probe->add_option("-o,--output", o->output,
                      ".csv; default: standard output. Values are left "
                      "out at points outside the grid");
    return {probe, [o] { run_probe(*o); }};
}
