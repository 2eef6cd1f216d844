// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <optional>

#include <nestgrid/error.hpp>

#include "coloured_surface.hpp"
#include "slice_options.hpp"

namespace {

struct Options {
    Input input;
    SurfaceOptions surface;
    SliceOptions slice;
    LensText lens;
    TimeOptions time;
    bool cap = false;
    bool outlines = false;
    double colour_tolerance = 0;
    std::optional<double> isovalue;
};

void run_slice(Options& o) {
    const SliceFunction f = slice_function(o.slice);
    if (o.isovalue && !std::isfinite(*o.isovalue)) {
        throw nestgrid::InvalidInput("--with-isosurface is not a finite number");
    }
    const ColouredSurface what{.function = f.function.get(),
                               .isovalue = o.isovalue,
                               .cap = o.cap,
                               .outlines = o.outlines,
                               .flat = f.flat,
                               .normal = f.normal,
                               .empty = "the slice does not meet the domain",
                               .lens = parse(o.lens),
                               .colour_tolerance = o.colour_tolerance};
    draw_coloured(o.input, o.surface, what, o.time);
}

}  // namespace

Command add_slice(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* slice = program.add_subcommand("slice", "draw a slice, coloured");
    add_input_options(*slice, o->input);
    add_slice_options(*slice, o->slice);
    add_surface_options(*slice, o->surface);
    add_lens_options(*slice, o->lens);
    add_time_options(*slice, o->time);
    CLI::Option* with_isosurface =
        slice->add_option("--with-isosurface", o->isovalue,
                          "draw the isosurface with this value beside the slice, in the same walk");
    CLI::Option* cap = slice->add_flag(
        "--cap", o->cap,
        "close the slice along the boundary, around the side that the normal points to, "
        "or the outside");
    cap->excludes(with_isosurface);
    slice->add_flag("--outlines", o->outlines, "draw the edges of elements, too");
    add_colour_option(*slice, o->colour_tolerance);
    return {slice, [o] { run_slice(*o); }};
}
