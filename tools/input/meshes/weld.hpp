// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/adapters/coarse.hpp>

/// Makes nodes that are no farther from each other than a tolerance one, in the place of the first
/// of them, by VTK. Elements that lose corners vanish, but for quadrilaterals that lose one, which
/// become triangles.
/// \param tolerance not negative, in the unit of the coordinates; 0 joins nodes in one place
/// \return how many nodes became others
std::size_t weld_nodes(nestgrid::CoarseGrid& grid, double tolerance);

bool has_nodes_in_one_place(const nestgrid::CoarseGrid& grid);
