// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Comparing many numbers at once.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include <nestgrid/inlining.hpp>

namespace nestgrid {

/// Bit i says that value[i] >= least.
/// \tparam count  4 ... 32
template <class Real, std::size_t count>
NESTGRID_INLINE unsigned at_least(const std::array<Real, count>& value, Real least) {
#if defined(__GNUC__)
    // 16 bytes at a time; the last ones may overlap with those before.
    constexpr std::size_t width = 16 / sizeof(Real);
    static_assert(count >= width && count <= 32);
    using Reals [[gnu::vector_size(16)]] = Real;
    using Integer = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    using Integers [[gnu::vector_size(16)]] = Integer;
    Integers bits{};
    unrolled<(count + width - 1) / width>([&](auto i) NESTGRID_INLINE_LAMBDA {
        constexpr std::size_t first = i * width + width <= count ? i * width : count - width;
        Reals some;
        std::memcpy(&some, value.data() + first, sizeof some);
        Integers bit;
        for (std::size_t k = 0; k < width; ++k) bit[k] = Integer{1} << (first + k);
        bits |= reinterpret_cast<Integers>(some >= least) & bit;
    });
    Integer result = 0;
    for (std::size_t k = 0; k < width; ++k) result |= bits[k];
    return static_cast<unsigned>(result);
#else
    unsigned bits = 0;
    for (std::size_t i = 0; i < count; ++i) bits |= unsigned{value[i] >= least} << i;
    return bits;
#endif
}

}  // namespace nestgrid
