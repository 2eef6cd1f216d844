// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a coarse grid must be before anything is built on it; one sentence for what it is not.
#pragma once

#include <nestgrid/adapters/coarse_graph.hpp>

namespace nestgrid {

/// What is looked for in a coarse grid, and what is allowed.
struct CoarseChecks {
    /// Two nodes at one place are meant: the two sides of a slit, a periodic image.
    bool slits = false;
};

namespace detail {

/// What is wrong with nodes alone, and with an element by itself.
/// \throw InvalidInput as check_and_orient()
void check_nodes(const CoarseGrid& grid, const CoarseChecks& options);
void check_element(const CoarseGrid& grid, std::size_t e);

}  // namespace detail

/// Checks a coarse grid and orients its elements: volumes positively, plane grids
/// counterclockwise, surfaces in space consistently.
/// \throw InvalidInput for an empty grid, coordinates that are no numbers, a node named twice or
///        not there, duplicate vertices, flat or inverted elements, a face of more than two
///        elements, a surface that cannot be oriented
void check_and_orient(CoarseGrid& grid, const CoarseChecks& options = {});

}  // namespace nestgrid
