// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/discontinuous.h>

#include <nestgrid/algorithms/discontinuous.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "drawn.hpp"
#include "function_in_c.hpp"

namespace {

using namespace nestgrid;

/// Data that a C code gives, on the grid of its table.
DiscontinuousData data_in_c(const nestgrid_grid* grid, const nestgrid_leaf_data* given) {
    if (grid == nullptr || given == nullptr) throw InvalidInput("a table is NULL");
    if (given->size < sizeof(nestgrid_leaf_data)) {
        throw InvalidInput("the table of the data of leaves is too small: its size says " +
                           std::to_string(given->size) + " bytes");
    }
    if (given->leaf_values == nullptr) {
        throw InvalidInput("the table of the data of leaves lacks the function 'leaf_values'");
    }
    if (given->components < 1) {
        throw InvalidInput("the data of leaves have " + std::to_string(given->components) +
                           " components");
    }
    const auto values = [table = *given](const Handle& leaf, std::span<double> out) {
        const std::size_t corners = out.size() / static_cast<std::size_t>(table.components);
        require_success(table.leaf_values(table.self, &detail::element_of<nestgrid_element>(leaf),
                                          corners, out.data()),
                        "the operation 'leaf_values' of the data of leaves");
    };
    return {open_table(*grid), given->components, values};
}

/// \throw InvalidInput for what data that jump are not drawn with
void require_no_more(const nestgrid_options& options) {
    const struct {
        const char* name;
        bool asked;
    } refused[] = {{"indicator", options.indicator != NESTGRID_OFFSET},
                   {"normals", options.normals != 0},
                   {"cap", options.cap != 0},
                   {"at_nodes", options.at_nodes != 0},
                   {"finest_cuts", options.finest_cuts != 0},
                   {"reference", options.reference != 0},
                   {"attributes", options.attribute_count > 0},
                   {"prerolls", options.prerolls != nullptr},
                   {"collapse", options.collapse != 0},
                   {"keep_distance", options.keep_distance != 0},
                   {"blend", options.blend != 0},
                   {"lens", options.lens != nullptr},
                   {"slice_distance", options.slice_distance != 0},
                   {"region", options.region != nullptr},
                   {"colour_tolerance", options.colour_tolerance != 0},
                   {"position_error", options.position_error != 0}};
    for (const auto& each : refused) {
        if (each.asked) {
            throw InvalidInput("data that jump are drawn without '" + std::string(each.name) +
                               "': leave it out of the options");
        }
    }
}

DiscontinuousOptions options_of(const Asked& asked) {
    asked.require_one_process("discontinuous data");
    require_no_more(asked.options());
    IsosurfaceOptions how = asked.how_to_draw();
    return {.threshold = std::max(asked.options().threshold, asked.options().error),
            .max_triangles = asked.options().max_triangles,
            .elements = how.elements,
            .progress = std::move(how.progress)};
}

/// Hands over what draw(data, options, executor) gives.
template <class Draw>
int draw(const nestgrid_grid* grid, const nestgrid_leaf_data* given, const nestgrid_options* asks,
         nestgrid_surface* out, char* message, size_t message_size, const Draw& draw_data) {
    *out = {};
    return with_options(asks, grid, nullptr, message, message_size, [&](const Asked& asked) {
        const DiscontinuousOptions options = options_of(asked);
        const DiscontinuousData data = data_in_c(grid, given);
        DiscontinuousSurface drawn = draw_data(data, options, asked.executor());
        Projected<Isosurface<3>> result;
        static_cast<ErrorBounds&>(result) = drawn;
        result.surface = std::move(drawn.surface);
        result.counts = drawn.counts;
        result.cancelled = drawn.cancelled;
        result.search = drawn.search;
        if (options.max_triangles == 0) result.search.threshold = options.threshold;
        hand_over(std::move(result), nullptr, *out);
        return 0;
    });
}

}  // namespace

extern "C" int nestgrid_discontinuous_height_field(const nestgrid_grid* grid,
                                                   const nestgrid_leaf_data* data, double scale,
                                                   const nestgrid_options* options,
                                                   nestgrid_surface* out, char* message,
                                                   size_t message_size) {
    return draw(grid, data, options, out, message, message_size,
                [&](const DiscontinuousData& jumping, const auto&... how) {
                    return height_field(jumping, scale, how...);
                });
}

extern "C" int nestgrid_discontinuous_slice(const nestgrid_grid* grid,
                                            const nestgrid_leaf_data* data, const double* through,
                                            const double* normal, const nestgrid_options* options,
                                            nestgrid_surface* out, char* message,
                                            size_t message_size) {
    return draw(grid, data, options, out, message, message_size,
                [&](const DiscontinuousData& jumping, const auto&... how) {
                    return slice(jumping, plane_in_c(through, normal), how...);
                });
}

extern "C" int nestgrid_discontinuous_slice_along(const nestgrid_grid* grid,
                                                  const nestgrid_leaf_data* data,
                                                  const nestgrid_level_function* function,
                                                  const nestgrid_options* options,
                                                  nestgrid_surface* out, char* message,
                                                  size_t message_size) {
    return draw(grid, data, options, out, message, message_size,
                [&](const DiscontinuousData& jumping, const auto&... how) {
                    return slice(jumping, FunctionInC(function), how...);
                });
}
