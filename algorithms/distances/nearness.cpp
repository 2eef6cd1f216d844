// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/algorithms/nearness.hpp>

#include <cmath>

#include <nestgrid/error.hpp>

namespace nestgrid {

void Nearness::require() const {
    if (!(distance > 0 && std::isfinite(distance))) {
        throw InvalidInput("the distance to keep is not a positive number");
    }
}

}  // namespace nestgrid
