// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <nestgrid/error.hpp>

#include "coloured_surface.hpp"
#include "slice_options.hpp"

namespace {

struct Options {
    Input input;
    SurfaceOptions surface;
    SliceOptions slice;
    LensText lens;
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
    SliceFunction f;
    if (is_sliced(o.slice)) f = slice_function(o.slice);
    draw_coloured(o.input, o.surface,
                  {.function = f.function.get(),
                   .flat = f.flat || f.function == nullptr,
                   .normal = f.function == nullptr ? nestgrid::Point{0, 0, 1} : f.normal,
                   .empty = "the slice does not meet the domain",
                   .values = o.values,
                   .value_count = o.count,
                   .lens = parse(o.lens)});
}

}  // namespace

Command add_isolines(CLI::App& program) {
    auto o = std::make_shared<Options>();
    CLI::App* isolines =
        program.add_subcommand("isolines", "draw isolines on a slice, or in a grid of dimension 2");
    add_input_options(*isolines, o->input);
    isolines->add_option("--values", o->values, "their values, in units of the data")
        ->delimiter(',');
    isolines->add_option("--count", o->count, "so many values, evenly within the range");
    add_slice_options(*isolines, o->slice);
    add_surface_options(*isolines, o->surface);
    add_lens_options(*isolines, o->lens);
    return {isolines, [o] { run_isolines(*o); }};
}
