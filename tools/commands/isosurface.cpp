// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <nestgrid/algorithms/cut_indicator.hpp>
#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"
#include "drawing/first_isovalue.hpp"
#include "drawing/vtk_contour.hpp"
#include "formats.hpp"

namespace {

using nestgrid::InvalidInput;

struct IsosurfaceArguments : DrawingOptions {
    std::vector<double> values;
    std::vector<double> box;
    double box_threshold = 0;
    bool cap = false;
    bool flat = false;
    bool at_nodes = false;
    bool keeps_distances = false;
    bool measures = false;
    std::string cuts;
    bool against_vtk = false;
};

FineBox fine_box(const IsosurfaceArguments& o) {
    FineBox box{{}, o.box_threshold};
    std::copy_n(o.box.begin(), 6, box.bounds.begin());
    for (std::size_t d = 0; d < 3; ++d) {
        if (!(box.bounds[2 * d] <= box.bounds[2 * d + 1])) {
            throw InvalidInput("--box is empty: its bounds are x,x,y,y,z,z in ascending order");
        }
    }
    if (!(box.threshold >= 0)) throw InvalidInput("--box-threshold is negative or not a number");
    return box;
}

bool is_by_slope(const IsosurfaceArguments& o) { return o.surface.projection.indicator == "slope"; }

/// How many options ask for an error, be it the least one of collapses to a number of triangles.
std::size_t errors_asked(const IsosurfaceArguments& o) {
    const CLI::App& command = *o.surface.command;
    const bool least = o.collapses && !is_by_slope(o);
    return command.count("--error") + (least ? command.count("--max-triangles") : 0);
}

/// \throw nestgrid::InvalidInput for values of which no surfaces can be told apart, and for options
///        that are for one value
void check_values(const IsosurfaceArguments& o) {
    std::vector<double> values = o.values;
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
        throw InvalidInput("--value is not a finite number");
    }
    std::ranges::sort(values);
    const auto twice = std::ranges::adjacent_find(values);
    if (twice != values.end()) {
        throw InvalidInput("--value has " + distinct_texts({*twice}).front() + " twice");
    }
    if (values.size() == 1) return;
    refuse_options(
        *o.surface.command,
        {"--max-triangles", "--collapse", "--distance-field", "--elements", "--against-vtk"},
        "is for one --value");
    if (o.surface.output.empty()) return;
    const std::string ending = o.surface.output_ending();
    const Format* const format = format_of("x" + ending);
    if (format != nullptr && !format->keeps_elements) {
        throw InvalidInput("several values need an --output as .vtp: in a " + ending +
                           " nothing tells their surfaces apart");
    }
}

/// \throw nestgrid::InvalidInput for options that do not go together
void check(const IsosurfaceArguments& o) {
    const CLI::App& command = *o.surface.command;
    const bool keeps =
        command.count("--distance") + command.count("--error") + command.count("--max-triangles") >
        0;
    if (o.collapses && !keeps) {
        throw InvalidInput("--collapse needs an --error, a --distance or --max-triangles to keep");
    }
    if (o.collapses && command.count("--indicator") > 0 && !is_by_slope(o)) {
        throw InvalidInput(
            "--collapse keeps an error: leave out --indicator, or take slope for the least "
            "distance");
    }
    if (!o.box.empty() && o.surface.projection.blend != 1) {
        throw InvalidInput("--box has two thresholds: leave out --blend");
    }
    check_values(o);
    if (o.input.labels.size() > 1 && !o.time.in_use()) {
        refuse_options(*o.surface.command, {"--against-vtk"}, "is for one part");
    }
    refuse_colours(o.surface.picture, "an isosurface has one colour");
}

DrawingRequest request_of(const IsosurfaceArguments& o) {
    DrawingRequest request = o.request();
    request.isovalues = o.values;
    request.cap = o.cap;
    request.normals = !o.flat;
    request.at_nodes = o.at_nodes;
    if (!o.cuts.empty()) {
        request.cuts = o.cuts == "finest" ? nestgrid::Cuts::finest : nestgrid::Cuts::linear;
    }
    if (!o.box.empty()) request.box = fine_box(o);
    request.keeps_distances = o.keeps_distances || (o.collapses && is_by_slope(o));
    request.measures = o.measures;
    return request;
}

int dimension_of(const InputField& field) { return field.dimension(); }

/// Refuses options that this field or this file leaves without effect.
void check_for(const IsosurfaceArguments& o, const InputField& field) {
    const CLI::App& command = *o.surface.command;
    if (!field.volumes || o.time.in_use()) {
        refuse_options(command, {"--against-vtk"}, "is for one volume");
    } else if (field.volumes->front().missing > 0) {
        refuse_options(command, {"--against-vtk"},
                       "is for volumes of which every sample has a value");
    }
    if (dimension_of(field) == 2) {
        refuse_options(command,
                       {"--cap", "--no-normals", "--collapse", "--distance-field", "--measure"},
                       "is for surfaces, not for isolines");
    }
    const std::string format = o.surface.output_ending();
    if (o.surface.picture.image.empty() && format == ".stl") {
        refuse_options(command, {"--no-normals"}, "changes no " + format + " file");
    }
}

/// Whether errors are those of the surface alone. Between frames the deviations of these serve,
/// without a preroll of each moment; in shapes other than simplices, cut deviations count the
/// flatness of triangles several times.
bool suits_cuts(const InputField& field) {
    return nestgrid::error_indicator(field.first().facts(), field.frames.count() > 1).of_level_sets;
}

void say_what_distances_are(const IsosurfaceArguments& o, const DrawingRequest& request,
                            const std::string& unit, Report& report) {
    const bool estimates = o.surface.projection.indicator == "slope";
    if (!estimates && !o.measures) return;
    std::string text =
        "distances are in " + (unit.empty() ? "the unit of the grid, which is not known" : unit);
    if (request.keeps_distances) {
        text +=
            "; no point of the surface is farther than the threshold from that of all data, and "
            "none of that from the surface";
    } else if (estimates) {
        text +=
            "; the threshold is an estimate: where the data are flat, the surface may be "
            "further off";
    }
    report.say(text);
}

void run_isosurface(IsosurfaceArguments& o, Report& report) {
    check(o);
    DrawingRequest request = request_of(o);
    nestgrid::Projection& projection = o.surface.projection;
    if (o.collapses && !is_by_slope(o)) projection.indicator = "deviation";
    request.look = [&](const InputField& field) {
        check_for(o, field);
        if (errors_asked(o) > 0 && suits_cuts(field)) projection.indicator = "cut";
    };
    request.add = [&](const InputField& field, Report& to) {
        if (o.against_vtk) report_contour(field.volumes->front(), o.values.front(), to);
        say_what_distances_are(o, request, field.length_unit, to);
    };
    draw(o, request, report);
}

/// The range of the data, and a value that shows the thing in them.
std::string advice(const IsosurfaceArguments& o) {
    if (o.input.path.empty()) return "";
    Input input = o.input;
    const InputField field = read_field(input, o.time.more, o.time.times, o.time.wanted());
    const ValueSample sample = value_sample_of(field.value_count, field.value);
    const auto texts = distinct_texts({sample.least, sample.greatest, readable_isovalue(sample)});
    const std::string name = "'" + o.input.path.string() + "'";
    if (texts[0] == texts[1]) return ": " + name + " has the value " + texts[0] + " everywhere";
    return ": the values of " + name + " are from " + texts[0] + " to " + texts[1] +
           ", try --value " + texts[2];
}

void add_box_options(CLI::App& command, IsosurfaceArguments& o) {
    CLI::Option* box =
        command.add_option("--box", o.box, "a box with a threshold of its own, --box-threshold")
            ->type_name("X,X,Y,Y,Z,Z")
            ->group("Detail")
            ->delimiter(',')
            ->expected(6);
    command.add_option("--box-threshold", o.box_threshold, "in units of --threshold [0]")
        ->type_name("NUMBER")
        ->group("Detail")
        ->needs(box);
}

Command add_isosurface(CLI::App& program) {
    auto o = std::make_shared<IsosurfaceArguments>();
    CLI::App* isosurface = program.add_subcommand("isosurface", "draw where the data have a value");
    isosurface->footer(
        "Prints:\n"
        "  error_bound: on no triangle do the data and the value differ by more.\n"
        "Examples:\n"
        "  nestgrid isosurface head.nii.gz --value 60 --threshold 2% -o head.vtp\n"
        "  nestgrid isosurface head.nii.gz --value 60 --max-triangles 5000 --image h.png\n");
    add_input(*isosurface, o->input);
    isosurface
        ->add_option("--value", o->values,
                     "the isovalue, in units of the data; several with commas are drawn at once, "
                     "and a .vtp tells that of each triangle")
        ->type_name("V,V,...")
        ->delimiter(',')
        ->take_all()
        ->allow_extra_args(false)
        ->required();
    add_surface_options(*isosurface, o->surface, true);
    add_elements_option(*isosurface, o->surface);
    isosurface
        ->add_option_function<std::vector<std::string>>(
            "--distance",
            [o](const std::vector<std::string>& distances) {
                o->surface.thresholds = distances;
                o->surface.projection.indicator = "slope";
            },
            "or let what is drawn be about this far from the surface of all data at most, in the "
            "unit of the grid: an estimate")
        ->type_name("LENGTH")
        ->take_all()
        ->excludes("--threshold")
        ->excludes("--max-triangles")
        ->excludes("--error")
        ->excludes("--indicator");
    isosurface
        ->add_flag("--distance-field", o->keeps_distances,
                   "keep the --distance there and back: look where the surfaces are farther from "
                   "each other, and draw more there")
        ->needs(isosurface->get_option("--distance"));
    isosurface->add_flag("--collapse", o->collapses,
                         "take edges away while the --error, or the --distance there and back, is "
                         "kept, or down to --max-triangles of the least error, or of the least "
                         "distance with --indicator slope: some times fewer triangles, some "
                         "times the time");
    isosurface->add_flag("--cap", o->cap, "close the surface along the boundary of the volume")
        ->group("Surface");
    isosurface
        ->add_flag("--no-normals", o->flat, "leave out the normals, and the time that they take")
        ->group("Surface");
    isosurface
        ->add_flag("--at-nodes", o->at_nodes,
                   "put vertices at samples that equal the isovalue, instead of slivers around "
                   "them")
        ->group("Surface");
    isosurface
        ->add_option("--cuts", o->cuts,
                     "where edges are cut: linear keeps the error, finest lies nearer to the data "
                     "[finest with --max-triangles and --distance]")
        ->type_name("KIND")
        ->check(CLI::IsMember({"linear", "finest"}))
        ->group("Surface")
        ->excludes("--at-nodes");
    for (const char* const other : {"--cap", "--at-nodes", "--threshold", "--elements"}) {
        isosurface->get_option("--collapse")->excludes(other);
    }
    isosurface
        ->add_flag("--measure", o->measures,
                   "measure the error and the distances from the surface of all data, there and "
                   "back")
        ->group("Surface")
        ->excludes("--cap");
    isosurface
        ->add_flag("--against-vtk", o->against_vtk,
                   "compare with VTK's own contour of the same samples")
        ->group("Surface");
    add_box_options(*isosurface, *o);
    add_time_options(*isosurface, o->time);
    add_lens_options(*isosurface, o->lens);
    for (const char* const other : {"--lens", "--box"}) {
        isosurface->get_option("--collapse")->excludes(other);
        isosurface->get_option("--distance-field")->excludes(other);
    }
    isosurface->get_option("--lens")->excludes("--box");
    add_read_options(*isosurface, o->input);
    return {isosurface, [o](Report& report) { run_isosurface(*o, report); },
            [o] { return advice(*o); }};
}

const RegisteredCommand isosurface_command(10, add_isosurface);

}  // namespace
