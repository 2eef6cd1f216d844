// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <optional>

#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"
#include "options/slice_options.hpp"

namespace {

struct SliceArguments : DrawingOptions {
    SliceOptions slice;
    bool cap = false;
    std::optional<double> isovalue;
};

void run_slice(SliceArguments& o, Report& report) {
    const SliceFunction f = slice_function(o.slice);
    if (o.isovalue && !std::isfinite(*o.isovalue)) {
        throw nestgrid::InvalidInput("--with-isosurface is not a finite number");
    }
    DrawingRequest request = o.request();
    request.function = f.function.get();
    request.isovalue = o.isovalue;
    request.cap = o.cap;
    request.flat = f.flat;
    request.normal = f.normal;
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
    add_read_options(*slice, o->input);
    return {slice, [o](Report& report) { run_slice(*o, report); }};
}

const RegisteredCommand slice_command(20, add_slice);

}  // namespace
