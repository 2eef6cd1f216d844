// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/draw.hpp"

#include <algorithm>
#include <utility>

#include <nestgrid/error.hpp>

#include "drawing/drawing.hpp"
#include "drawing/meter.hpp"
#include "drawing/panel.hpp"
#include "drawing/table.hpp"
#include "expression/expression.hpp"
#include "input/standard_input.hpp"
#include "output/collection.hpp"
#include "output/film.hpp"

namespace {

using nestgrid::InvalidInput;

/// Values of isolines between a least and a greatest one.
std::vector<double> values_between(double least, double greatest, int count) {
    std::vector<double> values;
    for (int i = 1; i <= count; ++i) {
        values.push_back(least + i * (greatest - least) / (count + 1));
    }
    return values;
}

void draw_isolines(Drawn& d, const std::vector<double>& values) {
    if (values.empty()) return;
    const Meter meter;
    d.isolines = nestgrid::isolines(d.result.surface, 0, values);
    d.seconds += meter.seconds();
}

/// The box as a region of a field.
nestgrid::RegionRequest region_of(const FineBox& box, int dimension) {
    nestgrid::Box domain;
    for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
        domain.low[d] = box.bounds[2 * d];
        domain.high[d] = box.bounds[2 * d + 1];
    }
    return {domain, box.threshold};
}

/// The field of an input, or those of its parts where it has several labels and one isosurface is
/// drawn of each.
std::vector<InputField> read_parts(const DrawingOptions& o, const DrawingRequest& request) {
    std::vector<InputField> parts;
    const auto read = [&](std::vector<double> labels) {
        Input input = o.input;
        input.labels = std::move(labels);
        parts.push_back(read_field(input, o.time.more, o.time.times, o.time.wanted()));
    };
    const bool several = o.input.labels.size() > 1 && request.in_one_colour() && !o.time.in_use();
    if (!several) read(o.input.labels);
    for (std::size_t i = 0; several && i < o.input.labels.size(); ++i) read({o.input.labels[i]});
    return parts;
}

/// Draws all surfaces of a command, and keeps them or writes those of a film.
class Surfaces {
public:
    Surfaces(const DrawingOptions& options, const DrawingRequest& request)
        : options_{options}, request_{request} {
        if (options.time.frames) film_.emplace(options.surface.output, options.surface.encoding);
    }

    void run(Report& report) {
        progress_.show("reading");
        const Meter reading;
        const std::vector<InputField> parts = read_parts(options_, request_);
        const InputField& first = parts.front();
        if (request_.look) request_.look(first);
        set_facts(first);
        field_.read_seconds = reading.seconds();
        expected_ = parts.size() * walks_of_part();
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const bool several = parts.size() > 1;
            draw_part(parts[i], several ? std::optional(options_.input.labels[i]) : std::nullopt);
        }
        film_ ? film_->finish(report) : keep(report);
        if (!first.note.empty()) report.say(first.note);
        report_drawn(field_, request_, report);
        if (request_.add) request_.add(first, report);
    }

private:
    std::size_t walks_of_part() const {
        const SurfaceOptions& s = options_.surface;
        const std::size_t moments =
            options_.time.frames ? static_cast<std::size_t>(*options_.time.frames) : 1;
        return moments * std::max<std::size_t>(1, s.thresholds.size() + s.budgets.size());
    }
    void set_facts(const InputField& read) {
        field_.name = request_.by.empty() ? read.name : request_.by;
        field_.input_name = read.name;
        field_.length_unit = read.length_unit;
        field_.space = read.space;
        field_.nodes = read.nodes;
        field_.leaf_elements = read.leaf_elements;
        field_.dimension = read.dimension();
        field_.values = request_.values;
    }
    /// Whether no other threshold than 0 is drawn at.
    bool asks_for_everything() const {
        const SurfaceOptions& s = options_.surface;
        return s.budgets.empty() && !request_.lens && !request_.box && !request_.collapses &&
               !request_.keeps_distances &&
               std::ranges::all_of(s.thresholds, [](const std::string& text) {
                   return parse_threshold(text).number == 0;
               });
    }
    /// Makes the prerolls of all frames, where they are needed.
    void preroll(const Moments& moments) {
        const bool spreads_values = film_ && request_.value_count > 0;
        if (is_drawn_exactly(request_, options_.surface) && !spreads_values) return;
        progress_.show("preroll", 0, 1);
        const auto& [least, greatest] = moments.range();
        if (request_.in_one_colour() && field_.surfaces.empty()) {
            field_.least = least;
            field_.greatest = greatest;
        }
        if (request_.has_isovalue() && field_.surfaces.empty()) {
            field_.outside = why_empty(request_, least, greatest);
        }
        // The range of all surfaces is known too late for a film: that of the frames takes its
        // place.
        if (spreads_values) {
            field_.values = values_between(least, greatest, request_.value_count);
        }
    }
    void draw_part(const InputField& part, const std::optional<double>& label) {
        nestgrid::Projection projection = options_.surface.projection;
        projection.lens = request_.lens;
        if (request_.box) projection.region = region_of(*request_.box, field_.dimension);
        if (asks_for_everything()) projection.threshold = 0;
        const Moments moments(part, options_.time, options_.input.path, std::move(projection),
                              request_.isovalues, options_.surface.threads,
                              [&](double share) { progress_.part(share); });
        preroll(moments);
        const Telling tell = [&](const std::string& work) {
            if (!work.empty()) return progress_.show(work);
            progress_.show("drawing", walks_, expected_);
        };
        moments.for_each([&](const Moment& moment) {
            draw_moment(moment, moments.executor(), options_.surface, request_, tell,
                        [&](std::vector<Drawn>&& walk) {
                            for (Drawn& d : walk) d.label = label;
                            take(std::move(walk));
                        });
        });
        const PrerollCost& cost = moments.preroll_cost();
        field_.preroll_seconds += cost.seconds;
        field_.preroll_peak_bytes = std::max(field_.preroll_peak_bytes, cost.peak_bytes);
        field_.preroll_kept_bytes = std::max(field_.preroll_kept_bytes, cost.kept_bytes);
    }
    void take(std::vector<Drawn> walk) {
        ++walks_;
        for (Drawn& d : walk) look_at(d);
        if (film_) {
            for (Drawn& d : walk) draw_isolines(d, field_.values);
            film_->add(data_of_walks(panels_of(walk), walk).front(), *walk.front().time);
        }
        const bool is_kept = !options_.surface.output.empty() ||
                             !options_.surface.picture.image.empty() || request_.value_count > 0;
        for (Drawn& d : walk) {
            if (film_ || (!is_kept && field_.values.empty())) {
                d.result.surface = {};
                d.segments = {};
                d.isosurface = {};
            }
            field_.surfaces.push_back(std::move(d));
        }
    }
    /// Colours a surface, and takes the range of its colours.
    void look_at(Drawn& d) {
        nestgrid::Surface<3>& surface = d.result.surface;
        if (!request_.by.empty() && surface.attributes.empty() && !surface.vertices.empty()) {
            colour(surface);
        }
        for (const double value : surface.attributes) {
            field_.least = std::min(field_.least, value);
            field_.greatest = std::max(field_.greatest, value);
        }
        const bool may_vanish = !request_.by.empty() && d.time;
        if (field_.surfaces.empty() && !may_vanish) require_triangles(d);
    }
    /// Gives an isosurface the values of an expression at its vertices, where it has no other
    /// field.
    void colour(nestgrid::Surface<3>& surface) {
        if (!expression_) expression_.emplace(request_.by);
        for (const nestgrid::Point& x : surface.vertices) {
            surface.attributes.push_back((*expression_)(x));
        }
    }
    void require_triangles(const Drawn& d) const {
        if (request_.empty.empty() || d.report.triangles > 0) return;
        const std::string reason = request_.function == nullptr ? field_.outside : "";
        throw InvalidInput(request_.empty + (reason.empty() ? "" : ": " + reason));
    }
    /// Draws isolines, and writes and paints the surfaces.
    void keep(Report& report) {
        if (request_.value_count > 0) {
            field_.values = values_between(field_.least, field_.greatest, request_.value_count);
        }
        for (Drawn& d : field_.surfaces) draw_isolines(d, field_.values);
        const SurfaceOptions& s = options_.surface;
        if (s.output.empty() && s.picture.image.empty()) return;
        std::vector<Panel> panels = panels_of(field_.surfaces);
        if (!s.output.empty()) write(panels, report);
        if (!s.picture.image.empty()) paint(panels, report);
    }
    /// The panels borrow the surfaces.
    std::vector<Panel> panels_of(std::vector<Drawn>& surfaces) const {
        std::vector<Panel> panels;
        for (Drawn& d : surfaces) {
            panels.push_back(make_panel(d, field_, request_, options_.surface.elements));
        }
        return panels;
    }
    /// One data set for each walk.
    std::vector<vtkSmartPointer<vtkPolyData>> data_of_walks(
        const std::vector<Panel>& panels, const std::vector<Drawn>& surfaces) const {
        std::vector<std::vector<vtkSmartPointer<vtkPolyData>>> walks;
        for (std::size_t i = 0; i < panels.size(); ++i) {
            if (!surfaces[i].shares_walk) walks.emplace_back();
            walks.back().push_back(data_of(panels[i], surfaces[i], field_, request_));
        }
        std::vector<vtkSmartPointer<vtkPolyData>> data;
        for (const auto& walk : walks) data.push_back(appended(walk));
        return data;
    }
    void write(const std::vector<Panel>& panels, Report& report) {
        progress_.show("writing");
        const Meter meter;
        const SurfaceOptions& s = options_.surface;
        write_surfaces(data_of_walks(panels, field_.surfaces), s.output, s.output_ending(),
                       s.encoding, report);
        field_.write_seconds = meter.seconds();
    }
    void paint(std::vector<Panel>& panels, Report& report) {
        progress_.show("painting");
        const Meter meter;
        const PictureOptions& picture = options_.surface.picture;
        for (Panel& panel : panels) {
            // An isosurface without normals is meant to be flat.
            if (!request_.in_one_colour() || panel.capped) shade(panel);
        }
        write_picture(panels, parse(picture), picture.image);
        field_.picture_seconds = meter.seconds();
        report.wrote(picture.image, {{"surfaces", panels.size()}});
    }

    const DrawingOptions& options_;
    const DrawingRequest& request_;
    ProgressLine progress_;
    std::optional<Film> film_;
    std::optional<Expression> expression_;
    DrawnField field_;
    std::size_t walks_ = 0;
    std::size_t expected_ = 1;  // walks
};

}  // namespace

DrawingRequest DrawingOptions::request() const {
    return {.by = input.by,
            .outlines = outlines,
            .lens = parse(lens),
            .colour_tolerance = colour_tolerance,
            .collapses = collapses};
}

void add_colour_options(CLI::App& command, DrawingOptions& options, const std::string& group,
                        bool has_tolerance) {
    command.add_flag("--outlines", options.outlines, "draw the edges of elements, too")
        ->group(group);
    if (!has_tolerance) return;
    command
        .add_option("--colour-tolerance", options.colour_tolerance,
                    "split triangles until colours follow the data within this")
        ->type_name("NUMBER")
        ->group(group)
        ->check(positive_number);
}

void add_collapse_option(CLI::App& command, DrawingOptions& options) {
    CLI::Option* const collapse =
        command.add_flag("--collapse", options.collapses,
                         "take edges away while the --error is kept, in place, or down to "
                         "--max-triangles of the least error: some times fewer triangles, some "
                         "times the time");
    for (const char* const other : {"--threshold", "--indicator", "--outlines", "--lens",
                                    "--colour-tolerance", "--with-isosurface", "--elements"}) {
        if (CLI::Option* const option = command.get_option_no_throw(other)) {
            collapse->excludes(option);
        }
    }
}

void draw(DrawingOptions& options, const DrawingRequest& request, Report& report) {
    check(options.surface);
    check(options.time);
    check_film(options.time, options.surface);
    if (request.collapses && !request.has_isovalue()) {
        const CLI::App& command = *options.surface.command;
        if (command.count("--error") + command.count("--max-triangles") == 0) {
            throw InvalidInput("--collapse needs an --error or --max-triangles to keep");
        }
        options.surface.projection.indicator = "deviation";
    }
    if (is_standard_stream(options.surface.output) && options.input.labels.size() > 1) {
        throw InvalidInput("standard output takes one surface: give -o a name for several");
    }
    for (const std::string& text : options.surface.thresholds) parse_threshold(text);
    Surfaces(options, request).run(report);
    say_what_was_kept(options.surface, report);
}
