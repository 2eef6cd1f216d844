// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
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
    TimeOptions time;
    bool cap = false;
    bool outlines = false;
};

void run_slice(Options& o) {
    const SliceFunction f = slice_function(o.slice);
    const ColouredSurface what{.function = f.function.get(),
                               .cap = o.cap,
                               .outlines = o.outlines,
                               .flat = f.flat,
                               .normal = f.normal,
                               .empty = "the slice does not meet the domain"};
    check(o.time, o.surface);
    if (o.time.in_use()) {
        draw_coloured(o.input, o.surface, what, o.time);
    } else {
        draw_coloured(o.input, o.surface, what);
    }
}

}  // namespace

Command add_slice(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* slice = program.add_subcommand("slice", "draw a slice, coloured");
    add_input_options(*slice, o->input);
    add_slice_options(*slice, o->slice);
    add_surface_options(*slice, o->surface);
    add_time_options(*slice, o->time);
    slice->add_flag(
        "--cap", o->cap,
        "close the slice along the boundary, around the side that the normal points to, "
        "or the outside");
    slice->add_flag("--outlines", o->outlines, "draw the edges of elements, too");
    return {slice, [o] { run_slice(*o); }};
}
