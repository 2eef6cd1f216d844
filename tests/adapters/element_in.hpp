// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/detail/elements.hpp>
#include <nestgrid/grid.hpp>

namespace nestgrid_test {

/// The element of the grid at which the view of a walk is.
template <class Grid>
const nestgrid::ElementOf<Grid>& element_in(const Grid&, const auto& view) {
    return nestgrid::detail::element_of<nestgrid::ElementOf<Grid>>(view.element());
}

}  // namespace nestgrid_test
