// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/isosurface.h>

#include <nestgrid/algorithms/isosurface.hpp>
#include <nestgrid/any_grid.hpp>
#include <nestgrid/check_grid.hpp>

namespace {

using namespace nestgrid;

void say(const std::string& sentence, char* message, std::size_t size) {
    if (message == nullptr || size == 0) return;
    const std::size_t length = std::min(sentence.size(), size - 1);
    std::memcpy(message, sentence.data(), length);
    message[length] = '\0';
}

/// Calls function(grid, field) with the models that the tables describe; exceptions become codes.
template <class Function>
int with_models(const nestgrid_grid* grid, const nestgrid_field* field, char* message,
                std::size_t size, Function&& function) noexcept {
    const auto with_values = [&](const auto& g) {
        if (field->value_type == NESTGRID_FLOAT) return function(g, AnyField<float>(*field));
        if (field->value_type == NESTGRID_DOUBLE) return function(g, AnyField<double>(*field));
        throw InvalidInput("the value_type " + std::to_string(field->value_type) +
                           " of the field is neither float nor double");
    };
    try {
        if (grid == nullptr || field == nullptr) throw InvalidInput("a table is NULL");
        if (grid->dimension == 2) return with_values(AnyGrid<2>(*grid));
        if (grid->dimension == 3) return with_values(AnyGrid<3>(*grid));
        throw InvalidInput("the table is of a grid of dimension " +
                           std::to_string(grid->dimension) + ", not 2 or 3");
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

}  // namespace

extern "C" int nestgrid_isosurface(const nestgrid_grid* grid, const nestgrid_field* field,
                                   double isovalue, double threshold, nestgrid_surface* out,
                                   char* message, size_t message_size) {
    *out = {};
    return with_models(grid, field, message, message_size, [&](const auto& g, const auto& f) {
        constexpr int dimension = std::remove_reference_t<decltype(g)>::dimension;
        using Result = Isosurface<dimension>;
        auto result = std::make_unique<Result>(
            isosurface(g, f, isovalue, {.threshold = threshold, .elements = false}));
        out->vertex_count = result->surface.vertices.size();
        out->simplex_count = result->surface.simplices.size();
        if (out->vertex_count > 0) out->vertices = result->surface.vertices.front().data();
        if (out->simplex_count > 0) out->simplices = result->surface.simplices.front().data();
        out->dimension = dimension;
        out->error_bound = result->error_bound;
        out->visited = result->counts.visited;
        out->extracted = result->counts.extracted;
        out->owner = result.release();
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
    return with_models(grid, field, message, message_size, [&](const auto& g, const auto& f) {
        const auto violation = check_grid(g, f);
        if (violation) say(violation->sentence, message, message_size);
        return violation ? 4 : 0;
    });
}
