// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/error.hpp>

#include "solid.hpp"

nestgrid::Distance read_solid(const std::filesystem::path& /*path*/) {
    throw nestgrid::InvalidInput(
        "this program was built without CGAL, which lenses by a surface need: configure with "
        "-DNESTGRID_CGAL=ON");
}
