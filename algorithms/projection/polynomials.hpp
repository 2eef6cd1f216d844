// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/field_on_grid.hpp>
#include <nestgrid/algorithms/high_order.hpp>

namespace nestgrid::engine {

/// The polynomials of a field, which keep it alive; null where no leaf is curved or
/// has a degree above 1.
///
/// \throw InvalidInput, GridError as HighOrder
std::shared_ptr<const HighOrder> polynomials_of(const FieldOnGrid& field, const Executor& executor);

}  // namespace nestgrid::engine
