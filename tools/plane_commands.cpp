// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The subcommands for grids of dimension 2: height and surface.
#include <cmath>

#include <nestgrid/error.hpp>

#include "coloured_surface.hpp"

namespace {

struct Options {
    Input input;
    SurfaceOptions surface;
    LensText lens;
    TimeOptions time;
    double scale = 0;
    bool outlines = false;
    double colour_tolerance = 0;
};

Command add(CLI::App& program, const char* name, const char* what, bool lifted) {
    auto o = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand(name, what);
    add_input_options(*command, o->input);
    add_surface_options(*command, o->surface);
    add_lens_options(*command, o->lens);
    add_time_options(*command, o->time);
    command->add_flag("--outlines", o->outlines, "draw the edges of elements, too");
    if (lifted) {
        command->add_option("--scale", o->scale, "heights in multiples of the field")->required();
    } else {
        add_colour_option(*command, o->colour_tolerance);
    }
    return {command, [o, lifted] {
                if (!std::isfinite(o->scale) || (lifted && o->scale == 0)) {
                    throw nestgrid::InvalidInput("--scale is 0 or not a finite number");
                }
                draw_coloured(o->input, o->surface,
                              {.scale = o->scale,
                               .outlines = o->outlines,
                               .flat = false,
                               .empty = "the hierarchy has no elements",
                               .lens = parse(o->lens),
                               .colour_tolerance = o->colour_tolerance},
                              o->time);
            }};
}

}  // namespace

Command add_height(CLI::App& program) {
    return add(program, "height", "draw a field in the plane as heights", true);
}

Command add_surface(CLI::App& program) {
    return add(program, "surface", "draw a grid of triangles or quadrilaterals, coloured", false);
}
