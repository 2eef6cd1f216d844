// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface.h>

#include <nestgrid/algorithms/height_field.hpp>
#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/algorithms/triangle_budget.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "check_table.hpp"
#include "drawn.hpp"

namespace {

using namespace nestgrid;

template <int dimension, class Real>
void draw(const Hierarchy<Real>& hierarchy, double isovalue, const Asked& asked,
          nestgrid_surface& out) {
    const Criteria criteria = asked.criteria(hierarchy, std::span(&isovalue, 1));
    const IsosurfaceOptions how = asked.how_to_draw();
    TriangleBudget search{.threshold = criteria.projection().least_threshold()};
    if (asked.options().max_triangles > 0) {
        search = find_threshold<dimension>(
            hierarchy, isovalue, [&](double threshold) { return criteria.at(threshold); },
            criteria.bounds(), asked.options().max_triangles, how, asked.executor());
    }
    hand_over(isosurface<dimension>(hierarchy, isovalue, criteria.at(search.threshold),
                                    criteria.bounds(), how, asked.executor()),
              search, out);
}

template <class Real>
int draw(const Hierarchy<Real>& hierarchy, double isovalue, const Asked& asked,
         nestgrid_surface& out) {
    if (hierarchy.facts().dimension == 2) {
        draw<2>(hierarchy, isovalue, asked, out);
    } else {
        draw<3>(hierarchy, isovalue, asked, out);
    }
    return 0;
}

template <class Real>
int draw_height_field(const Hierarchy<Real>& hierarchy, double scale, const Asked& asked,
                      nestgrid_surface& out) {
    hierarchy.facts().require_dimension(2);
    const Criteria criteria = asked.criteria(hierarchy, {});
    const IsosurfaceOptions how = asked.how_to_draw();
    const ShadingOptions options{.elements = how.elements, .progress = how.progress};
    TriangleBudget search{.threshold = criteria.projection().least_threshold()};
    if (asked.options().max_triangles > 0) {
        search = find_shading_threshold(
            hierarchy, [&](double threshold) { return criteria.at(threshold); }, criteria.bounds(),
            asked.options().max_triangles, options, asked.executor());
    }
    Shading graph = height_field(hierarchy, scale, criteria.at(search.threshold), criteria.bounds(),
                                 options, asked.executor());
    Isosurface<3> result;
    static_cast<ErrorBounds&>(result) = graph;
    result.surface = std::move(graph.surface);
    result.counts = graph.counts;
    result.cancelled = graph.cancelled;
    hand_over(std::move(result), search, out);
    return 0;
}

void require_one_component(const HierarchyFacts& facts) {
    if (facts.components == 1) return;
    throw InvalidInput("the field has " + std::to_string(facts.components) + " components, not 1");
}

/// The number of attributes that each vertex has.
template <int dimension>
std::size_t attribute_count(const Surface<dimension>& surface) {
    return surface.vertices.empty() ? 0 : surface.attributes.size() / surface.vertices.size();
}

template <class T>
const T* data_or_null(const std::vector<T>& values) {
    return values.empty() ? nullptr : values.data();
}
const double* data_or_null(const std::vector<Point>& points) {
    return points.empty() ? nullptr : points.front().data();
}

template <int dimension>
nestgrid_surface_details details(const Drawn<dimension>& drawn) {
    const Surface<dimension>& s = drawn.result.surface;
    static_assert(sizeof(Shape) == sizeof(std::uint8_t));
    nestgrid_surface_details d{};
    d.normals = data_or_null(s.normals);
    d.attribute_count = attribute_count(s);
    d.attributes = data_or_null(s.attributes);
    d.element_count = s.elements.size();
    if (d.element_count > 0) {
        d.elements = s.elements.template as<nestgrid_element>().data();
        d.shapes = reinterpret_cast<const std::uint8_t*>(s.shape_of.data());
        d.levels = s.level_of.data();
        d.element_of = s.element_of.data();
    }
    d.reference = data_or_null(s.reference);
    d.boundary_count = s.boundary.size();
    if (d.boundary_count > 0) d.boundary = s.boundary.front().data();
    d.threshold = drawn.threshold;
    d.surface_error = drawn.result.surface_error;
    d.cancelled = drawn.result.cancelled ? 1 : 0;
    d.budget_text = drawn.budget_text.c_str();
    return d;
}

}  // namespace

extern "C" int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field,
                                   double isovalue, double threshold, nestgrid_surface* out,
                                   char* message, size_t message_size) {
    *out = {};
    return without_exceptions(message, message_size, [&] {
        nestgrid_options options{};
        options.size = sizeof(options);
        options.threshold = threshold;
        const Asked asked(&options, grid, field);
        return with_tables(grid, field, {}, [&](const auto& hierarchy) {
            require_one_component(hierarchy.facts());
            return draw(hierarchy, isovalue, asked, *out);
        });
    });
}

extern "C" int nestgrid_isosurface_with(const nestgrid_grid* grid, const nestgrid_field* field,
                                        double isovalue, const nestgrid_options* options,
                                        nestgrid_surface* out, char* message, size_t message_size) {
    *out = {};
    return without_exceptions(message, message_size, [&] {
        const Asked asked(options, grid, field);
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw(hierarchy, isovalue, asked, *out);
        });
    });
}

extern "C" int nestgrid_height_field(const nestgrid_grid* grid, const nestgrid_field* field,
                                     double scale, const nestgrid_options* options,
                                     nestgrid_surface* out, char* message, size_t message_size) {
    *out = {};
    return without_exceptions(message, message_size, [&] {
        const Asked asked(options, grid, field);
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw_height_field(hierarchy, scale, asked, *out);
        });
    });
}

extern "C" int nestgrid_details(const nestgrid_surface* surface, nestgrid_surface_details* out,
                                char* message, size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        if (out == nullptr || out->size < sizeof(out->size)) {
            throw InvalidInput("the details are NULL, or their size is not that of the struct");
        }
        write_result(nestgrid_surface_details{}, out);
        if (surface == nullptr || surface->owner == nullptr) {
            throw InvalidInput("there is no surface to tell details of");
        }
        write_result(surface->dimension == 2 ? details(*static_cast<Drawn<2>*>(surface->owner))
                                             : details(*static_cast<Drawn<3>*>(surface->owner)),
                     out);
        return 0;
    });
}

extern "C" void nestgrid_surface_free(nestgrid_surface* surface) {
    if (surface->dimension == 2) {
        delete static_cast<Drawn<2>*>(surface->owner);
    } else {
        delete static_cast<Drawn<3>*>(surface->owner);
    }
    *surface = {};
}

extern "C" int nestgrid_check_grid(const nestgrid_grid* grid, const nestgrid_field* field,
                                   char* message, size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        return with_tables(grid, field, {}, [&](const auto& hierarchy) {
            require_one_component(hierarchy.facts());
            const auto violation = check_table(hierarchy, *grid, *field);
            if (violation) say(*violation, message, message_size);
            return violation ? 4 : 0;
        });
    });
}
