// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/boundary_surface.hpp>

#include "drawing/draw.hpp"

namespace {

void run_boundary(DrawingOptions& o, Report& report) {
    const nestgrid::detail::Everywhere everywhere;
    DrawingRequest request = o.request();
    request.function = &everywhere;
    request.cap = true;
    request.empty = "the hierarchy has no boundary";
    draw(o, request, report);
}

Command add_boundary(CLI::App& program) {
    auto o = std::make_shared<DrawingOptions>();
    CLI::App* boundary =
        program.add_subcommand("boundary", "draw the boundary of a grid in space, coloured");
    boundary->footer(
        "Prints:\n"
        "  error_bound: no colour on the boundary differs from the data by more.\n"
        "Examples:\n"
        "  nestgrid boundary part.nestgrid --outlines --image part.png\n");
    add_input(*boundary, o->input);
    add_surface_options(*boundary, o->surface);
    add_colour_options(*boundary, *o);
    add_elements_option(*boundary, o->surface);
    add_time_options(*boundary, o->time);
    add_lens_options(*boundary, o->lens);
    add_collapse_option(*boundary, *o);
    add_read_options(*boundary, o->input);
    return {boundary, [o](Report& report) { run_boundary(*o, report); }};
}

const RegisteredCommand boundary_command(60, add_boundary);

}  // namespace
