// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <nestgrid/algorithms/blended.hpp>

namespace nestgrid::engine {

/// blend_weight() as a float that is 1 only where eta <= epsilon: weights say so where S holds.
inline float float_weight(double eta, double epsilon, double factor) {
    constexpr float below_one = 1 - 0x1p-24F;  // the greatest float below 1
    if (eta <= epsilon) return 1;
    return std::min(static_cast<float>(detail::blend_weight(eta, epsilon, factor)), below_one);
}

}  // namespace nestgrid::engine
