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
    std::optional<double> isovalue;
    std::vector<double> values;
    int count = 0;
};

void run_isolines(Options& o) {
    if (o.values.empty() == (o.count == 0)) {
        throw nestgrid::InvalidInput("isolines need either --values or --count");
    }
    if (o.count < 0) throw nestgrid::InvalidInput("--count is negative");
    for (const double value : o.values) {
        if (!std::isfinite(value)) {
            throw nestgrid::InvalidInput("--values has a number that is not finite");
        }
    }
    if (o.isovalue && is_sliced(o.slice)) {
        throw nestgrid::InvalidInput("isolines run either on a slice or --on-surface");
    }
    if (o.isovalue && !std::isfinite(*o.isovalue)) {
        throw nestgrid::InvalidInput("--on-surface is not a finite number");
    }
    SliceFunction f;
    if (is_sliced(o.slice)) f = slice_function(o.slice);
    draw_coloured(
        o.input, o.surface,
        {.function = f.function.get(),
         .isovalue = o.isovalue,
         .flat = f.flat || f.function == nullptr,
         .normal = f.function == nullptr ? nestgrid::Point{0, 0, 1} : f.normal,
         .empty = o.isovalue ? "the isosurface is empty" : "the slice does not meet the domain",
         .values = o.values,
         .value_count = o.count,
         .lens = parse(o.lens)},
        o.time);
}

}  // namespace

Command add_isolines(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* isolines = program.add_subcommand(
        "isolines", "draw isolines on a slice, on an isosurface, or in a grid of dimension 2");
    add_input_options(*isolines, o->input);
    isolines->add_option("--values", o->values, "their values, in units of the data")
        ->delimiter(',');
    isolines->add_option("--count", o->count, "so many values, evenly within the range");
    add_slice_options(*isolines, o->slice);
    CLI::Option* on_surface = isolines->add_option(
        "--on-surface", o->isovalue,
        "on the isosurface with this value, in units of the data, in the place of a slice");
    CLI::Option* by = isolines->add_option(
        "--by", o->input.by,
        "what the isolines on it are of: another field of a .nestgrid file, or an expression in x, "
        "y and z");
    by->needs(on_surface);
    on_surface->needs(by);
    add_surface_options(*isolines, o->surface);
    add_lens_options(*isolines, o->lens);
    add_time_options(*isolines, o->time);
    return {isolines, [o] { run_isolines(*o); }};
}
