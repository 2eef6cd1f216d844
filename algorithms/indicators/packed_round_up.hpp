// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arithmetic that never rounds down, for several numbers at once. Each result has the bits of the
// function of the same name in detail/round_up.hpp.
#pragma once

#include <nestgrid/algorithms/detail/round_up.hpp>
#include <nestgrid/detail/pack.hpp>

namespace nestgrid::engine {

using nestgrid::detail::bfloat16_above;
using nestgrid::detail::distance_above;
using nestgrid::detail::sum_above;

/// The next floats above x where the error is positive, else x. Requires x >= 0.
template <std::size_t size>
Pack<float, size> raised(const Pack<float, size>& x, const Pack<float, size>& error) {
    const auto zero = Pack<float, size>::all(0);
    const auto raise = without(at_most(zero, error), at_most(error, zero));  // not where it is NaN
    return (x.template as<std::uint32_t>() - raise).template as<float>();    // a mask is -1
}

template <std::size_t size>
Pack<float, size> distance_above(const Pack<float, size>& a, const Pack<float, size>& b) {
    const Pack<float, size> greater = max(a, b);
    const Pack<float, size> less = min(a, b);
    const Pack<float, size> d = greater - less;
    const Pack<float, size> b_part = greater - d;
    return raised(d, (greater - (d + b_part)) + (b_part - less));
}

template <std::size_t size>
Pack<float, size> sum_above(const Pack<float, size>& a, const Pack<float, size>& b) {
    const Pack<float, size> s = a + b;
    const Pack<float, size> b_part = s - a;
    return raised(s, (a - (s - b_part)) + (b - b_part));
}

/// The bits lie in the upper halves of the numbers; the lower halves are 0.
template <std::size_t size>
Pack<std::uint32_t, size> bfloat16_above(const Pack<float, size>& x) {
    using Bits = Pack<std::uint32_t, size>;
    return (x.template as<std::uint32_t>() + Bits::all(0xFFFFU)) & Bits::all(0xFFFF0000U);
}

}  // namespace nestgrid::engine
