// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <nestgrid/hierarchy.hpp>

namespace nestgrid::engine {

/// For each coarse element, one bit each, the faces on the boundary of the coarse grid: no other
/// coarse element has a face with the same ids.
/// \throw GridError where a coarse element has a shape of another dimension than the grid
template <class Real>
std::vector<std::uint8_t> coarse_boundary(const Hierarchy<Real>& hierarchy);

}  // namespace nestgrid::engine
