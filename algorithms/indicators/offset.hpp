// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nestgrid/algorithms/detail/round_up.hpp>

namespace nestgrid::engine {

/// |U - sum omega U| at a new node, rounded up.
inline float offset_above(double value, double mean) {
    return detail::float_above(detail::distance_above(value, mean));
}
inline float offset_above(float value, float mean) { return detail::distance_above(value, mean); }

}  // namespace nestgrid::engine
