// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <optional>

#include <nestgrid/error.hpp>

#include "drawing/draw.hpp"
#include "options/slice_options.hpp"

namespace {

struct IsolinesArguments : DrawingOptions {
    SliceOptions slice;
    std::optional<double> isovalue;
    std::vector<double> values;
    int count = 0;
};

void run_isolines(IsolinesArguments& o, Report& report) {
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
    if (o.time.frames && o.isovalue && o.count > 0) {
        throw nestgrid::InvalidInput("a film of isolines on a surface needs --values");
    }
    SliceFunction f;
    if (is_sliced(o.slice)) f = slice_function(o.slice);
    DrawingRequest request = o.request();
    request.function = f.function.get();
    if (o.isovalue) request.isovalues = {*o.isovalue};
    request.values = o.values;
    request.value_count = o.count;
    request.flat = f.flat || f.function == nullptr;
    request.normal = f.function == nullptr ? nestgrid::Point{0, 0, 1} : f.normal;
    request.empty = o.isovalue ? "the isosurface is empty" : "the slice does not meet the domain";
    draw(o, request, report);
}

Command add_isolines(CLI::App& program) {
    auto o = std::make_shared<IsolinesArguments>();
    CLI::App* isolines = program.add_subcommand(
        "isolines", "draw isolines on a slice, on an isosurface, or in the plane");
    isolines->footer(
        "Prints:\n"
        "  error_bound: on no line do the data and its value differ by more.\n"
        "Examples:\n"
        "  nestgrid isolines head.nii.gz --axis z --at 30 --count 8 -o lines.vtp\n"
        "  nestgrid isolines hills.png --values 60,90,120 --image lines.png\n");
    add_input(*isolines, o->input);
    isolines->add_option("--values", o->values, "their values, in units of the data")
        ->type_name("V,V,...")
        ->delimiter(',');
    isolines->add_option("--count", o->count, "or so many values, evenly within the range")
        ->type_name("COUNT");
    add_slice_options(*isolines, o->slice);
    CLI::Option* on_surface =
        isolines->add_option("--on-surface", o->isovalue, "the isosurface with this value")
            ->type_name("NUMBER");
    CLI::Option* by =
        isolines
            ->add_option("--by", o->input.by,
                         "lines on it by another field of the file, or by an expression in x, y "
                         "and z")
            ->type_name("NAME");
    by->needs(on_surface);
    on_surface->needs(by);
    add_surface_options(*isolines, o->surface);
    add_time_options(*isolines, o->time);
    add_lens_options(*isolines, o->lens);
    add_read_options(*isolines, o->input);
    return {isolines, [o](Report& report) { run_isolines(*o, report); }};
}

const RegisteredCommand isolines_command(30, add_isolines);

}  // namespace
