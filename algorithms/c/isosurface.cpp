// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface.h>

#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

#include <nestgrid/algorithms/drawing.hpp>
#include <nestgrid/algorithms/join_pieces.hpp>

#include "asked.hpp"
#include "calls.hpp"
#include "check_table.hpp"
#include "drawn.hpp"

namespace {

using namespace nestgrid;

/// Draws on a grid of either dimension: calls
/// of_dimension(std::integral_constant<int, dimension>, prerolls, projection, options, work), and
/// hand_out(what it returns, projection).
template <class Real, class Draw, class HandOut>
int draw_any(const Hierarchy<Real>& hierarchy, const Asked& asked, const Draw& of_dimension,
             const HandOut& hand_out) {
    const Projection projection = asked.projection(hierarchy, true);
    const auto in = [&](auto dimension) {
        hand_out(asked.with_prerolls(hierarchy,
                                     [&](Prerolls& prerolls, const Work& work) {
                                         return of_dimension(dimension, prerolls, projection,
                                                             asked.how_to_draw(), work);
                                     }),
                 projection);
    };
    if (hierarchy.facts().dimension == 2) {
        in(std::integral_constant<int, 2>{});
    } else {
        in(std::integral_constant<int, 3>{});
    }
    return 0;
}

template <class Real, class Draw>
int draw(const Hierarchy<Real>& hierarchy, const Asked& asked, nestgrid_surface& out,
         const Draw& of_dimension) {
    return draw_any(hierarchy, asked, of_dimension, [&](auto drawn, const Projection&) {
        hand_over(std::move(drawn), asked.part(), out);
    });
}

/// Hands out several surfaces of one walk.
template <int dimension>
void hand_out(std::vector<Isosurface<dimension>> drawn, const Projection& projection,
              const Asked& asked, nestgrid_surface* out) {
    for (Isosurface<dimension>& one : drawn) {
        Projected<Isosurface<dimension>> result;
        static_cast<Isosurface<dimension>&>(result) = std::move(one);
        result.search.threshold = projection.threshold.value_or(0);
        hand_over(std::move(result), asked.part(), *out++);
    }
}

/// \throw InvalidInput where there is nothing to draw, or nowhere to put it
std::span<const double> require_isovalues(std::size_t count, const double* isovalues,
                                          const nestgrid_surface* out) {
    if (count == 0 || isovalues == nullptr || out == nullptr) {
        throw InvalidInput("there are no isovalues, or no surfaces for them");
    }
    return {isovalues, count};
}

template <class Real>
int draw_isosurface(const Hierarchy<Real>& hierarchy, double isovalue, const Asked& asked,
                    nestgrid_surface& out) {
    return draw(hierarchy, asked, out, [&](auto dimension, Prerolls& prerolls, const auto&... how) {
        return isosurface<dimension>(prerolls, isovalue, how...);
    });
}

template <class Real>
int draw_height_field(const Hierarchy<Real>& hierarchy, double scale, const Asked& asked,
                      nestgrid_surface& out) {
    hierarchy.facts().require_dimension(2);
    const IsosurfaceOptions how = asked.how_to_draw();
    const ShadingOptions options{.elements = how.elements, .progress = how.progress};
    const Projection projection = asked.projection(hierarchy, false);
    Projected<Shading> graph =
        asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) {
            return height_field(prerolls, scale, projection, options, work);
        });
    Projected<Isosurface<3>> result;
    static_cast<ErrorBounds&>(result) = graph;
    result.search = graph.search;
    result.surface = std::move(graph.surface);
    result.counts = graph.counts;
    result.position_bound = graph.position_bound;
    result.cancelled = graph.cancelled;
    result.names = std::move(graph.names);
    hand_over(std::move(result), asked.part(), out);
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

/// Empties a struct that begins with its size.
/// \throw InvalidInput where it is NULL, or too small for that
template <class Told>
void begin_told(Told* out, const std::string& name) {
    if (out == nullptr || out->size < sizeof(out->size)) {
        throw InvalidInput(name + " are NULL, or their size is not that of the struct");
    }
    write_result(Told{}, out);
}

constexpr std::size_t default_points = 200000;

nestgrid_measure_of in_c(const Measured& measured) {
    return {measured.greatest, measured.mean, measured.rms};
}
nestgrid_measured in_c(const MeasuredError& measured) {
    nestgrid_measured told{};
    told.value = in_c(measured.value);
    told.distance = in_c(measured.distance);
    told.back = in_c(measured.back);
    told.reach = measured.reach;
    told.points = measured.points;
    return told;
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
    d.threshold = drawn.result.search.threshold;
    d.surface_error = drawn.result.surface_error;
    d.cancelled = drawn.result.cancelled ? 1 : 0;
    d.budget_text = drawn.budget_text.c_str();
    d.position_bound = drawn.result.position_bound;
    return d;
}

}  // namespace

extern "C" int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field,
                                   double isovalue, double threshold, nestgrid_surface* out,
                                   char* message, size_t message_size) {
    *out = {};
    nestgrid_options options{};
    options.size = sizeof(options);
    options.threshold = threshold;
    return with_options(&options, grid, field, message, message_size, [&](const Asked& asked) {
        return with_tables(grid, field, {}, [&](const auto& hierarchy) {
            require_one_component(hierarchy.facts());
            return draw_isosurface(hierarchy, isovalue, asked, *out);
        });
    });
}

extern "C" int nestgrid_isosurface_with(const nestgrid_grid* grid, const nestgrid_field* field,
                                        double isovalue, const nestgrid_options* options,
                                        nestgrid_surface* out, char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw_isosurface(hierarchy, isovalue, asked, *out);
        });
    });
}

extern "C" int nestgrid_isosurfaces(const nestgrid_grid* grid, const nestgrid_field* field,
                                    size_t count, const double* isovalues,
                                    const nestgrid_options* options, nestgrid_surface* out,
                                    char* message, size_t message_size) {
    if (out != nullptr) std::fill_n(out, count, nestgrid_surface{});
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        const std::span<const double> values = require_isovalues(count, isovalues, out);
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw_any(
                hierarchy, asked,
                [&](auto dimension, Prerolls& prerolls, const auto&... how) {
                    return isosurfaces<dimension>(prerolls, values, how...);
                },
                [&](auto drawn, const Projection& projection) {
                    hand_out(std::move(drawn), projection, asked, out);
                });
        });
    });
}

extern "C" int nestgrid_isoband(const nestgrid_grid* grid, const nestgrid_field* field, double low,
                                double high, const nestgrid_options* options, nestgrid_surface* out,
                                char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw(hierarchy, asked, *out,
                        [&](auto dimension, Prerolls& prerolls, const auto&... how) {
                            return isoband<dimension>(prerolls, low, high, how...);
                        });
        });
    });
}

extern "C" int nestgrid_height_field(const nestgrid_grid* grid, const nestgrid_field* field,
                                     double scale, const nestgrid_options* options,
                                     nestgrid_surface* out, char* message, size_t message_size) {
    *out = {};
    return with_options(options, grid, field, message, message_size, [&](const Asked& asked) {
        return with_tables(grid, field, asked.attributes(), [&](const auto& hierarchy) {
            return draw_height_field(hierarchy, scale, asked, *out);
        });
    });
}

extern "C" int nestgrid_measure(const nestgrid_grid* grid, const nestgrid_field* field,
                                const nestgrid_surface* surface, double isovalue, uint64_t points,
                                const nestgrid_options* options, nestgrid_measured* out,
                                char* message, size_t message_size) {
    const auto begin = [&] { begin_told(out, "the measured errors"); };
    return with_options(
        options, grid, field, message, message_size, begin, [&](const Asked& asked) {
            asked.require_one_process("an error that is measured");
            if (surface == nullptr || surface->owner == nullptr || surface->dimension != 3) {
                throw InvalidInput("there is no isosurface in space to measure");
            }
            const Surface<3>& drawn = static_cast<Drawn<3>*>(surface->owner)->result.surface;
            return with_tables(grid, field, {}, [&](const auto& hierarchy) {
                const MeasuredError measured =
                    asked.with_prerolls(hierarchy, [&](Prerolls& prerolls, const Work& work) {
                        const auto count = static_cast<std::size_t>(points);
                        return measure_error(prerolls, drawn, isovalue,
                                             count == 0 ? default_points : count, work);
                    });
                write_result(in_c(measured), out);
                return 0;
            });
        });
}

extern "C" int nestgrid_details(const nestgrid_surface* surface, nestgrid_surface_details* out,
                                char* message, size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        begin_told(out, "the details");
        if (surface == nullptr || surface->owner == nullptr) {
            throw InvalidInput("there is no surface to tell details of");
        }
        write_result(surface->dimension == 2 ? details(*static_cast<Drawn<2>*>(surface->owner))
                                             : details(*static_cast<Drawn<3>*>(surface->owner)),
                     out);
        return 0;
    });
}

namespace {

template <int dimension>
JoinedPiece join(const Drawn<dimension>& piece) {
    if (!piece.part) {
        throw InvalidInput("the surface was drawn without ranks: it is the whole");
    }
    return detail::join_pieces(piece.result.surface, piece.result.names, piece.part->shared());
}

}  // namespace

extern "C" int nestgrid_join(const nestgrid_surface* piece, nestgrid_joined* out, char* message,
                             size_t message_size) {
    return without_exceptions(message, message_size, [&] {
        begin_result(out);
        if (piece == nullptr || piece->owner == nullptr) {
            throw InvalidInput("there is no piece of a surface to join");
        }
        auto owned = std::make_unique<JoinedPiece>(
            piece->dimension == 2 ? join(*static_cast<Drawn<2>*>(piece->owner))
                                  : join(*static_cast<Drawn<3>*>(piece->owner)));
        nestgrid_joined told{};
        told.numbers = data_or_null(owned->number);
        told.owners = data_or_null(owned->owner);
        told.vertices = owned->vertices;
        told.simplices = owned->simplices;
        told.components = owned->components;
        told.open = owned->open;
        told.owner = owned.release();
        write_result(told, out);
        return 0;
    });
}

extern "C" void nestgrid_joined_free(nestgrid_joined* joined) {
    delete static_cast<JoinedPiece*>(joined->owner);
    write_result(nestgrid_joined{}, joined);
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
