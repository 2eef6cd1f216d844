// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <nestgrid/nestgrid.h>
#include <nestgrid/hierarchy.hpp>

namespace nestgrid {

/// The first violation of the contract by two tables, or by the bisections that they tell.
/// \param hierarchy that was made of the tables
template <class Real>
std::optional<std::string> check_table(const Hierarchy<Real>& hierarchy, const nestgrid_grid& grid,
                                       const nestgrid_field& field);

}  // namespace nestgrid
