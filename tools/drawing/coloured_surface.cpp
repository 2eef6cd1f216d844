// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "drawing/coloured_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include <nestgrid/algorithms/collapse_colours.hpp>
#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/refine_colours.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "drawing/coloured_panel.hpp"
#include "drawing/extract.hpp"
#include "drawing/moments.hpp"
#include "expression/expression.hpp"
#include "output/collection.hpp"
#include "output/film.hpp"
#include "output/print.hpp"
#include "output/surface_file.hpp"

namespace {

/// \throw nestgrid::InvalidInput where the surface is none of a field of this dimension, or options
///        do not go together
void check(const ColouredSurface& what, const SurfaceOptions& options,
           const nestgrid::HierarchyFacts& facts) {
    const bool in_space = what.function != nullptr || what.isovalue;
    if (!in_space && facts.dimension == 3) {
        throw nestgrid::InvalidInput(
            "the field is one in space: give a slice, for isolines, or use 'isosurface'");
    }
    facts.require_dimension(in_space ? 3 : 2);
    if (what.colour_tolerance > 0 && !options.budgets.empty()) {
        throw nestgrid::InvalidInput("--max-triangles excludes --colour-tolerance");
    }
    if (what.collapses && options.command->count("--error") == 0) {
        throw nestgrid::InvalidInput("--collapse needs an --error to keep");
    }
}

/// Whether surfaces are drawn as finely as the grid is.
bool is_drawn_exactly(const ColouredSurface& what, const SurfaceOptions& options) {
    return options.thresholds.empty() && options.budgets.empty() && !what.lens && !what.isovalue;
}

/// Counts triangles, and keeps none.
class TriangleCounter final : public nestgrid::SimplexSink<3> {
public:
    struct Exceeded {};

    /// \param most take() throws Exceeded where there are more
    TriangleCounter(std::uint64_t& count, std::uint64_t most) : count_{&count}, most_{most} {}
    void take(const nestgrid::Surface<3>& part) override {
        *count_ += part.simplices.size();
        if (*count_ > most_) throw Exceeded{};
    }

private:
    std::uint64_t* count_;
    std::uint64_t most_;
};

/// Draws the surfaces at one moment.
template <class Real>
class Drawing {
public:
    Drawing(const nestgrid::Hierarchy<Real>& hierarchy, const Moment& moment,
            const SurfaceOptions& options, const ColouredSurface& what,
            const nestgrid::Executor& executor)
        : hierarchy_{hierarchy},
          moment_{moment},
          options_{options},
          what_{what},
          executor_{executor} {
        check(what, options, hierarchy.facts());
    }

    /// \param take take(drawn) takes each surface
    /// \param tell told whether a threshold is searched for; if not, a surface is drawn
    template <class Take>
    void draw_all(const Take& take, const std::function<void(bool searching)>& tell) {
        tell(false);
        if (is_drawn_exactly(what_, options_)) {
            take(draw({}, 0, [&](Drawn& d) { d.slice = draw_exactly(); }));
            return;
        }
        const ChosenIndicator& indicators = moment_.indicators();
        std::vector<ThresholdText> thresholds;
        for (const std::string& text : options_.thresholds) {
            thresholds.push_back(parse_threshold(text));
        }
        if (thresholds.empty() && options_.budgets.empty()) {
            set_default_threshold(thresholds, what_.lens.has_value());
        }
        indicators.with_criteria([&](const auto& criterion_at) {
            const auto take_at = [&](double threshold, const nestgrid::TriangleBudget& search) {
                tell(false);
                take(draw(search, threshold, [&](Drawn& d) {
                    if (!what_.collapses || !(threshold > 0)) {
                        return draw_with(criterion_at(threshold), d);
                    }
                    d.threshold = threshold / 2;
                    draw_with(criterion_at(threshold / 2), d);
                    collapse_one(threshold, d);
                }));
            };
            for (const std::int64_t budget : options_.budgets) {
                tell(true);
                const nestgrid::TriangleBudget search =
                    find_for(static_cast<std::uint64_t>(budget), criterion_at);
                take_at(search.threshold, search);
            }
            for (const ThresholdText& t : thresholds) take_at(indicators.threshold(t), {});
        });
    }

private:
    template <class Draw>
    Drawn draw(const nestgrid::TriangleBudget& search, double threshold, const Draw& draw_into) {
        Drawn drawn;
        drawn.search = search;
        drawn.time = moment_.time();
        drawn.threshold = threshold;
        const double start = now();
        draw_into(drawn);
        drawn.seconds = now() - start;
        drawn.report = nestgrid::surface_report(drawn.slice.surface);
        drawn.isosurface_report = nestgrid::surface_report(drawn.isosurface);
        return drawn;
    }

    nestgrid::Slice draw_exactly() const {
        nestgrid::Slice drawn = what_.function == nullptr ? triangles(0)
                                                          : slice(hierarchy_, *what_.function,
                                                                  {.cap = what_.cap}, executor_);
        refine(drawn.surface);
        return drawn;
    }
    /// Makes colours follow the data.
    /// \param with the criterion and the bounds that the surface was drawn with, or nothing
    template <class... With>
    void refine(nestgrid::Surface<3>& surface, const With&... with) const {
        if (what_.colour_tolerance > 0) {
            refine_colours(surface, hierarchy_, what_.colour_tolerance, with...);
        }
    }
    /// Takes edges away within an error, and tells it.
    void collapse_one(double error, Drawn& d) const {
        d.threshold = error;
        d.collapsed = collapse_colours(d.slice.surface, hierarchy_, moment_.indicators().bounds(),
                                       {.errors = {error}, .scale = what_.scale}, executor_);
        d.collapsed->hand_to(d.slice, d.slice.surface_error);
    }
    /// The least threshold at which the surface keeps within a number of triangles.
    template <class CriterionAt>
    nestgrid::TriangleBudget find_for(std::uint64_t budget, const CriterionAt& criterion_at) const {
        const nestgrid::IsosurfaceOptions options{.cap = what_.cap};
        return moment_.indicators().with_offsets([&](const auto& offsets) {
            if (what_.isovalue && what_.function != nullptr) {
                return nestgrid::least_threshold(
                    [&](double threshold, std::uint64_t most) {
                        return count_both(criterion_at(threshold), most);
                    },
                    offsets.greatest() - offsets.least(), budget);
            }
            if (what_.function != nullptr) {
                return find_threshold(hierarchy_, *what_.function, criterion_at, offsets, budget,
                                      options, executor_);
            }
            if (what_.isovalue) {
                return nestgrid::find_threshold<3>(hierarchy_, *what_.isovalue, criterion_at,
                                                   offsets, budget, options, executor_);
            }
            return find_shading_threshold(hierarchy_, criterion_at, offsets, budget, {}, executor_);
        });
    }
    /// Counts the triangles of the slice and of the isosurface beside it.
    std::optional<std::uint64_t> count_both(const nestgrid::Criterion& criterion,
                                            std::uint64_t most) const {
        std::uint64_t count = 0;
        const std::vector<TriangleCounter> counters(2, {count, most});
        try {
            extract_slices(hierarchy_, {{what_.function}, {*what_.isovalue}}, counters, criterion,
                           moment_.indicators().bounds(), {}, executor_);
        } catch (const TriangleCounter::Exceeded&) {
            return std::nullopt;
        }
        return count;
    }
    void draw_with(const nestgrid::Criterion& criterion, Drawn& drawn) const {
        const nestgrid::Bounds& bounds = moment_.indicators().bounds();
        nestgrid::IsosurfaceOptions options{.cap = what_.cap};
        if (what_.isovalue && what_.function != nullptr) {
            auto both = slices(hierarchy_, {{what_.function}, {*what_.isovalue}}, criterion, bounds,
                               options, executor_);
            drawn.slice = std::move(both[0]);
            drawn.isosurface = std::move(both[1].surface);
        } else if (what_.isovalue) {
            options.normals = true;
            drawn.slice =
                isosurface<3>(hierarchy_, *what_.isovalue, criterion, bounds, options, executor_);
        } else if (what_.function != nullptr) {
            drawn.slice = slice(hierarchy_, *what_.function, criterion, bounds, options, executor_);
        } else {
            drawn.slice = triangles(drawn.threshold, criterion, bounds);
        }
        if (what_.collapses && what_.scale == 0) {
            refine_colours(drawn.slice.surface, hierarchy_, drawn.threshold, criterion, bounds);
        }
        refine(drawn.slice.surface, criterion, bounds);
        if (!drawn.isosurface.attributes.empty()) refine(drawn.isosurface, criterion, bounds);
    }

    /// The grid of dimension 2.
    template <class... With>
    nestgrid::Slice triangles(double threshold, const With&... with) const {
        nestgrid::ShadingOptions options;
        if (what_.collapses) options.flatness = threshold;
        nestgrid::Shading s =
            what_.scale == 0 ? shading(hierarchy_, with..., options, executor_)
                             : height_field(hierarchy_, what_.scale, with..., options, executor_);
        return {s, std::move(s.surface), s.counts};
    }

    const nestgrid::Hierarchy<Real>& hierarchy_;
    const Moment& moment_;
    const SurfaceOptions& options_;
    const ColouredSurface& what_;
    const nestgrid::Executor& executor_;
};

/// What everybody wants to know of a surface comes first.
Row row_of(const Drawn& d, const ColouredSurface& what) {
    Row row = begin_row(d.time, d.search.max_triangles, d.threshold);
    row.add("triangles", d.report.triangles).add("vertices", d.report.vertices);
    row.add("error_bound", bound_of(d.slice)).add("open_edges", d.report.open_edges);
    row.add("area", d.report.area).add("seconds", d.seconds);
    if (what.isovalue && what.function != nullptr) {
        row.add("isosurface_triangles", d.isosurface_report.triangles);
        row.add("isosurface_open_edges", d.isosurface_report.open_edges);
        row.add("isosurface_area", d.isosurface_report.area);
    }
    if (d.collapsed) {
        row.add("collapses", d.collapsed->collapses).add("exceeding", d.collapsed->exceeding);
    }
    row.add("boundary_edges", d.report.boundary_edges);
    row.add("inspect_calls", d.slice.counts.calls).add("visited", d.slice.counts.visited);
    return row.add("extracted", d.slice.counts.extracted);
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
        Row row = begin_row(d.time, d.search.max_triangles, d.threshold);
        row.add("isoline", value).add("rings", rings).add("open_lines", open);
        report.add_row("isolines", row.add("length", length),
                       keys_of(d.time, d.search.max_triangles) + 1);
    }
}

void report_drawn(const DrawnField& field, const ColouredSurface& what, Report& report) {
    report_field(field.name, field.length_unit, report);
    report_range({field.least, field.greatest}, report);
    if (field.preroll_seconds > 0) report.add("preroll_seconds", field.preroll_seconds);
    std::uint64_t triangles = 0;
    double seconds = 0;
    std::vector<nestgrid::TriangleBudget> searches;
    for (const Drawn& d : field.surfaces) {
        searches.push_back(d.search);
        report.add_row("surfaces", row_of(d, what), keys_of(d.time, d.search.max_triangles));
        report_isolines(d, field.values, report);
        triangles += d.report.triangles + d.isosurface_report.triangles;
        seconds += d.seconds;
    }
    report_sum(field.surfaces.size(), triangles, "triangles", seconds, report);
    say_why_not_filled(searches, report);
    if (std::ranges::any_of(field.surfaces,
                            [](const Drawn& d) { return d.slice.bound_says_nothing(); })) {
        say_nothing_bounded(report);
    }
}

/// Gives an isosurface that has no other field the values of an expression at its vertices.
void colour_by(const Expression& f, nestgrid::Surface<3>& surface) {
    for (const nestgrid::Point& x : surface.vertices) surface.attributes.push_back(f(x));
}

/// Values of isolines between a least and a greatest one.
std::vector<double> values_between(double least, double greatest, int count) {
    std::vector<double> values;
    for (int i = 1; i <= count; ++i) {
        values.push_back(least + i * (greatest - least) / (count + 1));
    }
    return values;
}

/// Draws the isolines on a surface.
void draw_isolines(Drawn& d, const std::vector<double>& values) {
    if (values.empty()) return;
    const double start = now();
    d.isolines = nestgrid::isolines(d.slice.surface, 0, values);
    d.seconds += now() - start;
}

/// Widens the range of the colours by those of a surface.
void add_range(const Drawn& d, DrawnField& field) {
    for (const double value : d.slice.surface.attributes) {
        field.least = std::min(field.least, value);
        field.greatest = std::max(field.greatest, value);
    }
}

void write(const SurfaceOptions& options, const DrawnField& field, const ColouredSurface& what,
           Report& report) {
    std::vector<Panel> panels;
    std::vector<vtkSmartPointer<vtkPolyData>> written;
    for (std::size_t i = 0; i < field.surfaces.size(); ++i) {
        panels.push_back(make_panel(field.surfaces[i], field, what));
        Panel& panel = panels.back();
        if (!options.output.empty()) {
            written.push_back(data_of(panel, !field.values.empty()));
            describe(written.back(), field.length_unit, field.space);
        }
        shade(panel);
    }
    if (!written.empty()) write_surfaces(written, options.output, report);
    if (options.picture.image.empty()) return;
    write_picture(panels, parse(options.picture), options.picture.image);
    report.wrote(options.picture.image, {{"surfaces", panels.size()}});
}

/// Why there is no isosurface, where that is because of its value; else nothing.
std::string why_empty(const Moments& moments, const ColouredSurface& what) {
    if (!what.isovalue) return "";
    return outside_range(*what.isovalue, moments.prerolls().least(), moments.prerolls().greatest());
}

void require_triangles(const Drawn& d, const Moments& moments, const ColouredSurface& what) {
    if (d.report.triangles > 0) return;
    const std::string reason = what.function == nullptr ? why_empty(moments, what) : "";
    throw nestgrid::InvalidInput(what.empty + (reason.empty() ? "" : ": " + reason));
}

/// Draws the surfaces at all moments.
/// \param film takes the surfaces, which are then dropped; or null
/// \param tell told how many surfaces are drawn, and whether a threshold is searched for
void draw_moments(const Moments& moments, const SurfaceOptions& options,
                  const ColouredSurface& what, const std::string& by, Film* film, DrawnField& field,
                  const std::function<void(std::size_t, bool searching)>& tell) {
    std::optional<Expression> expression;
    const bool by_another = what.isovalue && what.function == nullptr;
    field.values = what.values;
    if (film != nullptr && what.value_count > 0) {
        // The range of all surfaces is known too late for a film: that of the frames takes its
        // place.
        const FramePrerolls& all = moments.prerolls();
        field.values = values_between(all.least(), all.greatest(), what.value_count);
    }
    moments.for_each([&](const Moment& moment) {
        moment.visit([&]<class Real>(const nestgrid::Hierarchy<Real>& hierarchy) {
            Drawing<Real> drawing(hierarchy, moment, options, what, moments.executor());
            const auto take = [&](Drawn&& d) {
                const nestgrid::Surface<3>& surface = d.slice.surface;
                if (by_another && surface.attributes.empty() && !surface.vertices.empty()) {
                    if (!expression) expression.emplace(by);
                    colour_by(*expression, d.slice.surface);
                }
                add_range(d, field);
                const bool may_vanish = by_another && d.time;
                if (field.surfaces.empty() && !may_vanish) require_triangles(d, moments, what);
                if (film != nullptr) {
                    draw_isolines(d, field.values);
                    const auto data = data_of(make_panel(d, field, what), !field.values.empty());
                    describe(data, field.length_unit, field.space);
                    film->add(data, *d.time);
                    d.slice.surface = {};
                    d.isosurface = {};
                }
                field.surfaces.push_back(std::move(d));
            };
            drawing.draw_all(take, [&](bool searching) { tell(field.surfaces.size(), searching); });
        });
    });
    if (film != nullptr) return;
    if (what.value_count > 0) {
        field.values = values_between(field.least, field.greatest, what.value_count);
    }
    for (Drawn& d : field.surfaces) draw_isolines(d, field.values);
}

}  // namespace

CLI::Option* add_colour_option(CLI::App& command, double& tolerance) {
    return command
        .add_option("--colour-tolerance", tolerance,
                    "split triangles until colours follow the data within this")
        ->type_name("NUMBER")
        ->check(positive_number);
}

void add_collapse_option(CLI::App& command, bool& collapses) {
    CLI::Option* const collapse =
        command.add_flag("--collapse", collapses,
                         "take edges away while the --error is kept, in place: some times fewer "
                         "triangles, some times the time");
    for (const char* const other : {"--threshold", "--max-triangles", "--outlines", "--lens",
                                    "--colour-tolerance", "--with-isosurface"}) {
        if (CLI::Option* const option = command.get_option_no_throw(other)) {
            collapse->excludes(option);
        }
    }
}

void draw_coloured(Input& input, SurfaceOptions& options, const ColouredSurface& what,
                   const TimeOptions& time, Report& report) {
    check(options);
    check(time);
    check_film(time, options);
    if (time.frames && what.isovalue && what.function == nullptr && what.value_count > 0) {
        throw nestgrid::InvalidInput("a film of isolines on a surface needs --values");
    }
    for (const std::string& text : options.thresholds) parse_threshold(text);
    DrawnField field;
    ProgressLine progress;
    progress.show("reading");
    std::optional<Film> film;
    if (time.frames) film.emplace(options.output);
    const std::filesystem::path path = input.path;
    const InputField read = read_field(input, time.more, time.times, time.wanted());
    const Moments moments(read, time, path, options.projection, what.lens, options.threads,
                          [&](double share) { progress.part(share); });
    field.input_name = read.name;
    field.length_unit = read.length_unit;
    field.space = read.space;
    const bool by_another = what.isovalue && what.function == nullptr;
    field.name = by_another ? input.by : read.name;
    const std::size_t expected =
        time.frames ? static_cast<std::size_t>(*time.frames)
                    : std::max<std::size_t>(1, options.thresholds.size() + options.budgets.size());
    if (!is_drawn_exactly(what, options)) {
        progress.show("preroll", 0, 1);
        moments.prerolls();
    }
    draw_moments(moments, options, what, input.by, film ? &*film : nullptr, field,
                 [&](std::size_t done, bool searching) {
                     if (searching) return progress.show("searching the threshold");
                     progress.show("drawing", done, expected);
                 });
    field.preroll_seconds = moments.preroll_seconds();
    progress.show("writing");
    if (film) {
        film->finish(report);
    } else {
        write(options, field, what, report);
    }
    report_drawn(field, what, report);
    if (!read.note.empty()) report.say(read.note);
    const std::string reason = why_empty(moments, what);
    if (!reason.empty()) report.say("the isosurface is empty: " + reason);
    say_what_was_kept(options, report);
}
