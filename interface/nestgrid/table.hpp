// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of C functions (nestgrid.h) as hierarchies, for C++ programs that are handed such tables.
#pragma once

#include <memory>
#include <span>

#include <nestgrid/nestgrid.h>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid {

/// The grid and the field of two tables. The tables are copied; what they point to is borrowed,
/// rules excepted. Elements are nestgrid_element.
/// \tparam Real float or double, as the value_type of the field
/// \throw InvalidInput for a table without a required function, for a rule that make_rule refuses,
///        for a dimension other than 2 or 3, and for values of another type than Real
/// Later on, an operation that fails is a GridError with the sentence of the table's last_error.
template <class Real>
std::unique_ptr<const Hierarchy<Real>> open_table(const nestgrid_grid& grid,
                                                  const nestgrid_field& field);

/// The grid of a table with several fields, whose components stand behind each other.
/// \param more fields behind the first one, of float or double each, whose values become Real and
///        whose gradients are not asked for
/// \throw InvalidInput also where one of them is NULL
template <class Real>
std::unique_ptr<const Hierarchy<Real>> open_table(const nestgrid_grid& grid,
                                                  const nestgrid_field& field,
                                                  std::span<const nestgrid_field* const> more);

/// The grid of a table, with a field that is zero.
std::unique_ptr<const Hierarchy<float>> open_table(const nestgrid_grid& grid);

}  // namespace nestgrid
