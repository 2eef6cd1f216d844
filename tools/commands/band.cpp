// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"

namespace {

using nestgrid::InvalidInput;

struct BandArguments : DrawingOptions {
    double low = 0;
    double high = 0;
    bool flat = false;
};

void run_band(BandArguments& o, Report& report) {
    if (!std::isfinite(o.low)) throw InvalidInput("--low is not a finite number");
    if (!std::isfinite(o.high)) throw InvalidInput("--high is not a finite number");
    if (!(o.low < o.high)) throw InvalidInput("--low is not below --high");
    refuse_colours(o.surface.picture, "a band has one colour");
    DrawingRequest request = o.request();
    request.isovalues = {o.low};
    request.upper = o.high;
    request.normals = !o.flat;
    draw(o, request, report);
}

Command add_band(CLI::App& program) {
    auto o = std::make_shared<BandArguments>();
    CLI::App* band =
        program.add_subcommand("band", "draw the surface around all data between two values");
    band->footer(
        "Prints:\n"
        "  error_bound: on no triangle do the data and the nearer value differ by more.\n"
        "Examples:\n"
        "  nestgrid band head.nii.gz --low 40 --high 60 --threshold 2% -o tissue.vtp\n");
    add_input(*band, o->input);
    band->add_option("--low", o->low, "the lower value, in units of the data")
        ->type_name("NUMBER")
        ->required();
    band->add_option("--high", o->high, "the upper one")->type_name("NUMBER")->required();
    add_surface_options(*band, o->surface);
    add_elements_option(*band, o->surface);
    band->add_flag("--no-normals", o->flat, "leave out the normals, and the time that they take")
        ->group("Surface");
    add_time_options(*band, o->time);
    add_lens_options(*band, o->lens);
    add_read_options(*band, o->input);
    return {band, [o](Report& report) { run_band(*o, report); }};
}

const RegisteredCommand band_command(25, add_band);

}  // namespace
