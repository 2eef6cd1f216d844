// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"
#include "options/slice_options.hpp"

namespace {

struct SliceArguments : DrawingOptions {
    SliceOptions slice;
    bool cap = false;
    std::optional<double> isovalue;
    double distance = 0;
};

void say_how_near(double distance, const std::string& unit, Report& report) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "no point of the slice is farther than %.4g from that of all data, and none of "
                  "that from the slice, in ",
                  distance);
    report.say(text.data() + (unit.empty() ? "the unit of the grid, which is not known" : unit));
}

void run_slice(SliceArguments& o, Report& report) {
    const SliceFunction f = slice_function(o.slice);
    if (o.isovalue && !std::isfinite(*o.isovalue)) {
        throw nestgrid::InvalidInput("--with-isosurface is not a finite number");
    }
    if (o.distance > 0 && f.flat) {
        throw nestgrid::InvalidInput(
            "--distance is for curved slices: a plane keeps its place, leave it out");
    }
    DrawingRequest request = o.request();
    request.function = f.function.get();
    if (o.isovalue) request.isovalues = {*o.isovalue};
    request.cap = o.cap;
    request.flat = f.flat;
    request.normal = f.normal;
    request.slice_distance = o.distance;
    if (o.distance > 0) {
        request.add = [&](const InputField& field, Report& to) {
            say_how_near(o.distance, field.length_unit, to);
        };
    }
    request.empty = "the slice does not meet the domain";
    draw(o, request, report);
}

Command add_slice(CLI::App& program) {
    auto o = std::make_shared<SliceArguments>();
    CLI::App* slice =
        program.add_subcommand("slice", "draw a plane, sphere, cylinder or other slice, coloured");
    slice->footer(
        "Prints:\n"
        "  error_bound: no colour on the slice differs from the data by more.\n"
        "Examples:\n"
        "  nestgrid slice head.nii.gz --axis z --at 30 --threshold 2% --image slice.png\n"
        "  nestgrid slice head.nii.gz --sphere 5,12,17,4 --max-triangles 2000 -o ball.vtp\n");
    add_input(*slice, o->input);
    add_slice_options(*slice, o->slice);
    add_surface_options(*slice, o->surface);
    CLI::Option* with_isosurface =
        slice
            ->add_option("--with-isosurface", o->isovalue,
                         "draw the isosurface with this value beside the slice")
            ->type_name("NUMBER")
            ->group("Slice");
    slice
        ->add_flag("--cap", o->cap,
                   "close the slice along the boundary, around the side that its normal points to, "
                   "or its outside")
        ->group("Slice")
        ->excludes(with_isosurface);
    add_colour_options(*slice, *o, "Slice");
    add_elements_option(*slice, o->surface);
    add_time_options(*slice, o->time);
    add_lens_options(*slice, o->lens);
    add_collapse_option(*slice, *o);
    slice
        ->add_option("--distance", o->distance,
                     "with --collapse, let a curved slice be this far from that of all data at "
                     "most, there and back, in the unit of the grid [it keeps its place]")
        ->type_name("LENGTH")
        ->check(positive_number)
        ->needs(slice->get_option("--collapse"))
        ->excludes(slice->get_option("--cap"));
    add_read_options(*slice, o->input);
    return {slice, [o](Report& report) { run_slice(*o, report); }};
}

const RegisteredCommand slice_command(20, add_slice);

}  // namespace
