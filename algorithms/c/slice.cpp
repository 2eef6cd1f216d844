// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/slice.h>

#include <nestgrid/algorithms/drawing.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "drawn.hpp"
#include "function_in_c.hpp"

namespace {

using namespace nestgrid;

/// Draws on the grid of the tables what slice(prerolls, projection, options, work) gives.
template <class Draw>
int draw(const nestgrid_grid* grid, const nestgrid_field* field, const Asked& asked,
         nestgrid_surface& out, const Draw& slice) {
    return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
        hierarchy.facts().require_dimension(3);
        const Projection projection = asked.projection(hierarchy, false);
        auto drawn = asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) {
            return slice(prerolls, projection, asked.how_to_draw(), work);
        });
        hand_over(std::move(drawn), asked.part(), out);
        return 0;
    });
}

}  // namespace

extern "C" int nestgrid_slice(const nestgrid_grid* grid, const nestgrid_field* field,
                              const double* through, const double* normal,
                              const nestgrid_options* options, nestgrid_surface* out, char* message,
                              size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        const Plane plane = plane_in_c(through, normal);
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return slice(prerolls, plane, how...);
        });
    });
}

extern "C" int nestgrid_slice_along(const nestgrid_grid* grid, const nestgrid_field* field,
                                    const nestgrid_level_function* function,
                                    const nestgrid_options* options, nestgrid_surface* out,
                                    char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        const FunctionInC in_c(function);
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return slice(prerolls, in_c, how...);
        });
    });
}

extern "C" int nestgrid_boundary_surface(const nestgrid_grid* grid, const nestgrid_field* field,
                                         const nestgrid_options* options, nestgrid_surface* out,
                                         char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        return draw(grid, field, asked, *out, [&](Prerolls& prerolls, const auto&... how) {
            return boundary_surface(prerolls, how...);
        });
    });
}
