// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface.h>

#include <algorithm>
#include <cstring>
#include <string>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/table.hpp>

#include "check_table.hpp"

namespace {

using namespace nestgrid;

void say(const std::string& sentence, char* message, std::size_t size) {
    if (message == nullptr || size == 0) return;
    const std::size_t length = std::min(sentence.size(), size - 1);
    std::memcpy(message, sentence.data(), length);
    message[length] = '\0';
}

template <class Real>
auto one_component(std::unique_ptr<const Hierarchy<Real>> hierarchy) {
    const int components = hierarchy->facts().components;
    if (components == 1) return hierarchy;
    throw InvalidInput("the field has " + std::to_string(components) + " components, not 1");
}

/// Calls function(hierarchy) with what the tables describe; exceptions become codes.
template <class Function>
int with_tables(const nestgrid_grid* grid, const nestgrid_field* field, char* message,
                std::size_t size, Function&& function) noexcept {
    try {
        if (grid == nullptr || field == nullptr) throw InvalidInput("a table is NULL");
        if (field->value_type == NESTGRID_FLOAT) {
            return function(one_component(open_table<float>(*grid, *field)));
        }
        if (field->value_type == NESTGRID_DOUBLE) {
            return function(one_component(open_table<double>(*grid, *field)));
        }
        throw InvalidInput("the value_type " + std::to_string(field->value_type) +
                           " of the field is neither float nor double");
    } catch (const InvalidInput& e) {
        say(e.what(), message, size);
        return 1;
    } catch (const std::exception& e) {
        say(e.what(), message, size);
        return 2;
    } catch (...) {
        say("unknown failure", message, size);
        return 3;
    }
}

template <int dimension, class Real>
void draw(const Hierarchy<Real>& hierarchy, double isovalue, double threshold,
          nestgrid_surface& out) {
    auto result = std::make_unique<Isosurface<dimension>>(
        isosurface<dimension>(hierarchy, isovalue, {.threshold = threshold, .elements = false}));
    out.vertex_count = result->surface.vertices.size();
    out.simplex_count = result->surface.simplices.size();
    if (out.vertex_count > 0) out.vertices = result->surface.vertices.front().data();
    if (out.simplex_count > 0) out.simplices = result->surface.simplices.front().data();
    out.dimension = dimension;
    out.error_bound = result->error_bound;
    out.range_bound = result->range_bound;
    out.bound_says_nothing = result->bound_says_nothing() ? 1 : 0;
    out.visited = result->counts.visited;
    out.extracted = result->counts.extracted;
    out.owner = result.release();
}

}  // namespace

extern "C" int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field,
                                   double isovalue, double threshold, nestgrid_surface* out,
                                   char* message, size_t message_size) {
    *out = {};
    return with_tables(grid, field, message, message_size, [&](const auto& hierarchy) {
        if (hierarchy->facts().dimension == 2) {
            draw<2>(*hierarchy, isovalue, threshold, *out);
        } else {
            draw<3>(*hierarchy, isovalue, threshold, *out);
        }
        return 0;
    });
}

extern "C" void nestgrid_surface_free(nestgrid_surface* surface) {
    if (surface->dimension == 2) {
        delete static_cast<Isosurface<2>*>(surface->owner);
    } else {
        delete static_cast<Isosurface<3>*>(surface->owner);
    }
    *surface = {};
}

extern "C" int nestgrid_check_grid(const nestgrid_grid* grid, const nestgrid_field* field,
                                   char* message, size_t message_size) {
    return with_tables(grid, field, message, message_size, [&](const auto& hierarchy) {
        const auto violation = check_table(*hierarchy, *grid, *field);
        if (violation) say(*violation, message, message_size);
        return violation ? 4 : 0;
    });
}
