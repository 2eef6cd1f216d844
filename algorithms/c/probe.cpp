// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/probe.h>

#include <nestgrid/algorithms/drawing.hpp>

#include "asked.hpp"
#include "calls.hpp"

namespace {

using namespace nestgrid;

static_assert(NESTGRID_NO_ELEMENT == ProbeResult::no_element);

std::vector<Point> points_of(const double* points, std::size_t count) {
    if (count > 0 && points == nullptr) throw InvalidInput("the points are NULL");
    std::vector<Point> result(count);
    for (std::size_t i = 0; i < count; ++i) std::copy_n(points + 3 * i, 3, result[i].begin());
    return result;
}

template <class Real>
ProbeResult ask(const Hierarchy<Real>& hierarchy, std::span<const Point> points,
                const Asked& asked) {
    if (asked.options().max_triangles > 0) {
        throw InvalidInput("a number of triangles is asked for, but a probe draws none");
    }
    const Projection projection = asked.projection(hierarchy, false);
    return asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) {
        return probe(prerolls, points, projection, work);
    });
}

/// Hands values to a C code, which frees them.
int hand_over(ProbeResult result, nestgrid_probed* out) {
    auto owned = std::make_unique<ProbeResult>(std::move(result));
    nestgrid_probed told{};
    told.point_count = owned->level.size();
    told.found = told.point_count -
                 static_cast<std::size_t>(std::count(owned->level.begin(), owned->level.end(), -1));
    told.component_count = owned->components;
    if (told.point_count > 0) {
        told.values = owned->values.data();
        told.levels = owned->level.data();
        told.element_of = owned->element_of.data();
        told.reference = owned->reference.front().data();
    }
    told.element_count = owned->elements.size();
    if (told.element_count > 0) {
        told.elements = owned->elements.as<nestgrid_element>().data();
        told.shapes = reinterpret_cast<const std::uint8_t*>(owned->shape_of.data());
    }
    told.owner = owned.release();
    write_result(told, out);
    return 0;
}

}  // namespace

extern "C" int nestgrid_probe(const nestgrid_grid* grid, const nestgrid_field* field,
                              const double* points, size_t count, const nestgrid_options* options,
                              nestgrid_probed* out, char* message, size_t message_size) {
    const auto begin = [&] { begin_result(out); };
    return with_options(
        options, grid, field, message, message_size, begin, [&](const Asked& asked) {
            const std::vector<Point> at = points_of(points, count);
            return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
                return hand_over(ask(hierarchy, at, asked), out);
            });
        });
}

extern "C" void nestgrid_probed_free(nestgrid_probed* probed) {
    delete static_cast<ProbeResult*>(probed->owner);
    write_result(nestgrid_probed{}, probed);
}
