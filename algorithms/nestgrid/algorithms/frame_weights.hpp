// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How much each of several frames counts at a time between them (paper, section 5.3).
//
// Invariants:
//   - the weights are multiples of 2^-23 and their sum is exactly 1: frames that are equal stay
//   what
//     they are at every time, to the last bit where values are float;
//   - at the time of a frame its weight is 1, that of all others 0.
// Consequence: a time counts up to 2^-24 of the interval it lies in.
#pragma once

#include <span>
#include <vector>

namespace nestgrid {

/// One weight for each time. At most two are not 0: those of the frames around t.
/// \param times of the frames, ascending
/// \throw InvalidInput where times do not ascend or are not finite, and where t does not lie
/// between
///        the first and the last of them
std::vector<float> linear_weights(std::span<const double> times, double t);

/// Weights of cubic polynomials through the frames, whose slope at a frame is that of the line
/// through its neighbours (Catmull and Rom); at the first and the last frame, that of the line to
/// the only neighbour. At most four are not 0; those of the outer two are negative.
std::vector<float> catmull_rom_weights(std::span<const double> times, double t);

namespace detail {

/// \throw InvalidInput where there is not one weight for each frame, and where a weight is not
///        finite
void require_weights(std::size_t frames, std::span<const float> weights);

}  // namespace detail

}  // namespace nestgrid
