// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <nestgrid/algorithms/probe.hpp>
#include <nestgrid/error.hpp>

#include "extract.hpp"
#include "input_hierarchy.hpp"
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
    std::string threshold = "0";
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

template <class Real>
std::string table(const nestgrid::Hierarchy<Real>& hierarchy, const std::string& name,
                  const std::vector<Point>& points, const std::string& threshold) {
    const ThresholdText t = parse_threshold(threshold);
    nestgrid::ProbeResult result;
    if (t.number == 0) {
        result = nestgrid::probe(hierarchy, points);
    } else {
        const nestgrid::HierarchicalIndicator indicator(hierarchy);
        const double range = indicator.greatest() - indicator.least();
        const nestgrid::Threshold s(&indicator, t.in_units(range));
        result = nestgrid::probe(hierarchy, points, s, indicator);
    }
    std::ostringstream out;
    out.precision(17);
    out << "x,y,z," << name << ",level\n";
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto& [x, y, z] = points[i];
        out << x << ',' << y << ',' << z << ',';
        if (result.found(i)) out << result.values[i * result.components] << ',' << result.level[i];
        if (!result.found(i)) out << ',';
        out << '\n';
    }
    return out.str();
}

void run_probe(Options& o) {
    if (o.line.empty() == o.points.empty()) {
        throw InvalidInput("a probe needs either --line or --points");
    }
    if (o.count < 2) throw InvalidInput("--count is below 2");
    if (!o.output.empty()) check_writable(o.output);
    parse_threshold(o.threshold);
    std::vector<Point> points;
    if (o.line.empty()) {
        points = read_points(o.points);
    } else {
        points = nestgrid::detail::make_line({o.line[0], o.line[1], o.line[2]},
                                             {o.line[3], o.line[4], o.line[5]},
                                             static_cast<std::size_t>(o.count))
                     .points;
    }
    std::string text;
    with_field(o.input, [&](const auto& hierarchy, const std::string& name) {
        text = table(hierarchy, name, points, o.threshold);
    });
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
    probe->add_option("--threshold", o->threshold,
                      "offsets up to this are projected away: in units of the data, or in percent "
                      "of their range (2%)");
    probe->add_option("-o,--output", o->output,
                      ".csv; default: standard output. Values are left "
                      "out at points outside the grid");
    return {probe, [o] { run_probe(*o); }};
}
