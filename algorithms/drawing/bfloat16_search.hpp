// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace nestgrid::engine {

/// So many bfloat16 numbers lie from x to 2 x.
inline constexpr int octave = 128;

/// Codes of two thresholds, of which the greater one fits and the lesser one does not; or one code.
struct Bracket {
    std::uint16_t beyond;
    std::uint16_t within;
};

/// The least code in (beyond, within] that fits. Requires: `within` fits, `beyond` does not, and
/// what is above a code that fits does.
template <class Fits>
std::uint16_t least_that_fits(std::uint16_t beyond, std::uint16_t within, Fits&& fits) {
    while (within - beyond > 1) {
        const auto middle = static_cast<std::uint16_t>((within + beyond) / 2);
        (fits(middle) ? within : beyond) = middle;
    }
    return within;
}

}  // namespace nestgrid::engine
