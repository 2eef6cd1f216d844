// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/boundary_surface.hpp>

#include "drawing/coloured_surface.hpp"

namespace {

struct BoundaryArguments {
    Input input;
    SurfaceOptions surface;
    LensText lens;
    TimeOptions time;
    bool outlines = false;
    bool collapses = false;
    double colour_tolerance = 0;
};

Command add_boundary(CLI::App& program) {
    auto o = std::make_shared<BoundaryArguments>();
    CLI::App* boundary =
        program.add_subcommand("boundary", "draw the boundary of a grid in space, coloured");
    boundary->footer(
        "Prints:\n"
        "  error_bound: no colour on the boundary differs from the data by more.\n"
        "Examples:\n"
        "  nestgrid boundary part.nestgrid --outlines --image part.png\n");
    add_input(*boundary, o->input);
    add_surface_options(*boundary, o->surface);
    boundary->add_flag("--outlines", o->outlines, "draw the edges of elements, too");
    add_colour_option(*boundary, o->colour_tolerance);
    add_time_options(*boundary, o->time);
    add_lens_options(*boundary, o->lens);
    add_collapse_option(*boundary, o->collapses);
    add_read_options(*boundary, o->input);
    return {boundary, [o](Report& report) {
                const nestgrid::detail::Everywhere everywhere;
                draw_coloured(o->input, o->surface,
                              {.function = &everywhere,
                               .cap = true,
                               .outlines = o->outlines,
                               .empty = "the hierarchy has no boundary",
                               .lens = parse(o->lens),
                               .colour_tolerance = o->colour_tolerance,
                               .collapses = o->collapses},
                              o->time, report);
            }};
}

const RegisteredCommand boundary_command(60, add_boundary);

}  // namespace
