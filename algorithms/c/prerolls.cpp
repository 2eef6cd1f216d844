// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prerolls.hpp"

#include "calls.hpp"

void nestgrid_prerolls::require_same(const nestgrid_grid& of_grid, const nestgrid_field& of_field) {
    const std::scoped_lock lock(mutex);
    if (used && (grid != of_grid.self || field != of_field.self)) {
        throw nestgrid::InvalidInput("the prerolls were made for another grid or field");
    }
    used = true;
    grid = of_grid.self;
    field = of_field.self;
}

extern "C" int nestgrid_prerolls_make(nestgrid_prerolls** out, char* message, size_t message_size) {
    return nestgrid::without_exceptions(message, message_size, [&] {
        if (out == nullptr) throw nestgrid::InvalidInput("the result is NULL");
        *out = nullptr;
        *out = std::make_unique<nestgrid_prerolls>().release();
        return 0;
    });
}

extern "C" void nestgrid_prerolls_free(nestgrid_prerolls* prerolls) { delete prerolls; }
