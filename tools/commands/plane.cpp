// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands for grids of dimension 2: height and surface.
#include <cmath>

#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"

namespace {

struct PlaneArguments : DrawingOptions {
    double scale = 0;
};

void run_plane(PlaneArguments& o, bool lifted, Report& report) {
    if (!std::isfinite(o.scale) || (lifted && o.scale == 0)) {
        throw nestgrid::InvalidInput("--scale is 0 or not a finite number");
    }
    DrawingRequest request = o.request();
    request.scale = o.scale;
    request.empty = "the hierarchy has no elements";
    draw(o, request, report);
}

Command add(CLI::App& program, const char* name, const char* what, const char* example,
            bool lifted) {
    auto o = std::make_shared<PlaneArguments>();
    CLI::App* command = program.add_subcommand(name, what);
    command->footer(
        std::string("Prints:\n"
                    "  error_bound: nowhere does what is drawn of the data differ from them by "
                    "more.\n"
                    "Examples:\n  ") +
        example);
    add_input(*command, o->input);
    if (lifted) {
        command->add_option("--scale", o->scale, "heights in multiples of the field")
            ->type_name("FACTOR")
            ->required();
    }
    add_surface_options(*command, o->surface);
    add_colour_options(*command, *o, "Options", !lifted);
    add_elements_option(*command, o->surface);
    add_time_options(*command, o->time);
    add_lens_options(*command, o->lens);
    add_collapse_option(*command, *o);
    add_read_options(*command, o->input);
    return {command, [o, lifted](Report& report) { run_plane(*o, lifted, report); }};
}

Command add_height(CLI::App& program) {
    return add(program, "height", "draw a field in the plane, or a grey picture, as heights",
               "nestgrid height hills.png --scale 0.2 --threshold 1% -o hills.stl", true);
}

const RegisteredCommand height_command(40, add_height);

Command add_surface(CLI::App& program) {
    return add(program, "surface", "draw a grid of triangles or quadrilaterals, coloured",
               "nestgrid surface hills.png --threshold 2% --outlines --image hills-grid.png",
               false);
}

const RegisteredCommand surface_command(50, add_surface);

}  // namespace
