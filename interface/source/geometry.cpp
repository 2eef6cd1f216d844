// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/detail/geometry.hpp>

namespace nestgrid {

std::string text_of(const Point& x) {
    return "(" + std::to_string(x[0]) + ", " + std::to_string(x[1]) + ", " + std::to_string(x[2]) +
           ")";
}

}  // namespace nestgrid
