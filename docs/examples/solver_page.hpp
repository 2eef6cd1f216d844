// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The option --view of the solvers among the examples: a page for browsers shows their surfaces
// while they run. Without NESTGRID_VIEW there is none.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <nestgrid/algorithms/surface.hpp>

struct SolverSurface {
    nestgrid::Surface<3> surface;
    std::string field;  ///< name of the attributes
    std::uint64_t step = 0;
    std::optional<double> time{};
};

/// Shows a surface in the place of the last one.
using ShowSurface = std::function<void(SolverSurface)>;

/// Serves a page as long as the function exists, and prints its address.
/// \param box the domain
/// \throw InvalidInput where this build has no page
ShowSurface show_in_page(const std::string& title, const std::array<nestgrid::Point, 2>& box);

/// Takes --view out of the arguments. \return whether it was there
bool take_view_option(int& argc, char** argv);

/// Keeps the last surface in the page until Enter.
void wait_for_enter();
