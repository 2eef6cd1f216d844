// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isolines.h>

#include <nestgrid/algorithms/drawing.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "drawn.hpp"

namespace {

using namespace nestgrid;

std::span<const double> values_of(const double* values, std::size_t count) {
    if (count > 0 && values == nullptr) throw InvalidInput("the values of the isolines are NULL");
    return {values, count};
}

/// Hands lines to a C code, which frees them.
int hand_over(Isolines result, nestgrid_lines* out) {
    auto owned = std::make_unique<Isolines>(std::move(result));
    const Polylines& lines = owned->lines;
    nestgrid_lines told{};
    told.vertex_count = lines.vertices.size();
    if (told.vertex_count > 0) told.vertices = lines.vertices.front().data();
    told.attribute_count = lines.attribute_count;
    told.attributes = lines.attributes.empty() ? nullptr : lines.attributes.data();
    told.line_count = lines.count();
    told.first = lines.first.data();
    if (told.line_count > 0) {
        told.points = lines.points.data();
        told.values = lines.value.data();
    }
    told.error_bound = owned->error_bound;
    told.range_bound = owned->range_bound;
    told.visited = owned->counts.visited;
    told.extracted = owned->counts.extracted;
    told.cancelled = owned->cancelled ? 1 : 0;
    told.position_bound = owned->position_bound;
    told.owner = owned.release();
    write_result(told, out);
    return 0;
}

template <class Real>
Isolines draw(const Hierarchy<Real>& hierarchy, std::span<const double> values,
              const Asked& asked) {
    if (asked.options().max_triangles > 0) {
        throw InvalidInput("a limit of segments is for one isoline: take nestgrid_isosurface_with");
    }
    const Projection projection = asked.projection(hierarchy, true);
    return asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) -> Isolines {
        return isolines(prerolls, values, projection, asked.how_to_draw(), work);
    });
}

}  // namespace

extern "C" int nestgrid_isolines(const nestgrid_grid* grid, const nestgrid_field* field,
                                 const double* values, size_t count,
                                 const nestgrid_options* options, nestgrid_lines* out,
                                 char* message, size_t message_size) {
    const auto begin = [&] { begin_result(out); };
    return with_options(
        options, grid, field, message, message_size, begin, [&](const Asked& asked) {
            const auto isovalues = values_of(values, count);
            return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
                return hand_over(draw(hierarchy, isovalues, asked), out);
            });
        });
}

extern "C" int nestgrid_surface_isolines(const nestgrid_surface* surface, size_t attribute,
                                         const double* values, size_t count, nestgrid_lines* out,
                                         char* message, size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        begin_result(out);
        if (surface == nullptr || surface->owner == nullptr || surface->dimension != 3) {
            throw InvalidInput("there is no surface of triangles to draw isolines on");
        }
        const auto& drawn = *static_cast<const Drawn<3>*>(surface->owner);
        Isolines result;
        result.lines = isolines(drawn.result.surface, attribute, values_of(values, count));
        return hand_over(std::move(result), out);
    });
}

extern "C" void nestgrid_lines_free(nestgrid_lines* lines) {
    delete static_cast<Isolines*>(lines->owner);
    write_result(nestgrid_lines{}, lines);
}
