// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "solver_page.hpp"

ShowSurface show_in_page(const std::string&, const std::array<nestgrid::Point, 2>&) {
    throw nestgrid::InvalidInput("this example has no page: configure with -DNESTGRID_VIEW=ON");
}
