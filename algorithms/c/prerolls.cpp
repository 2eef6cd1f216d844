// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "prerolls.hpp"

#include "calls.hpp"

nestgrid::Prerolls& nestgrid_prerolls::of(const nestgrid_grid& grid, const nestgrid_field& field,
                                          const nestgrid::FieldOnGrid& hierarchy) {
    const std::scoped_lock lock(mutex_);
    if (prerolls_ && (grid_ != grid.self || field_ != field.self)) {
        throw nestgrid::InvalidInput("the prerolls were made for another grid or field");
    }
    grid_ = grid.self;
    field_ = field.self;
    if (!prerolls_) prerolls_.emplace(hierarchy);
    return *prerolls_;
}

std::shared_ptr<const nestgrid::PartOnRanks> nestgrid_prerolls::part_of(
    const nestgrid_ranks& ranks, const nestgrid_grid& grid,
    const nestgrid::FieldOnGrid& hierarchy) {
    const std::scoped_lock lock(mutex_);
    if (!part_) part_ = std::make_shared<const nestgrid::PartOnRanks>(ranks, grid, hierarchy);
    return part_;
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
