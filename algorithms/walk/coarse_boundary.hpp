// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// The faces of each coarse element whose ids occur once on the coarse grid, one bit each.
/// \throw GridError where a coarse element has a shape of another dimension than the grid
template <class Real>
std::vector<std::uint8_t> coarse_boundary(const Hierarchy<Real>& hierarchy);

}  // namespace nestgrid::engine
