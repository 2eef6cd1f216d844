// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a compiler cannot guess of functions that call themselves: which to unroll, and which not.
// Under a sanitizer it may guess: unrolled functions grow there until they take it minutes.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#if defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define NESTGRID_INLINE [[gnu::always_inline]] inline
#define NESTGRID_INLINE_LAMBDA __attribute__((always_inline))
#define NESTGRID_NOINLINE [[gnu::noinline]]
#else
#define NESTGRID_INLINE inline
#define NESTGRID_INLINE_LAMBDA
#define NESTGRID_NOINLINE
#endif

namespace nestgrid {

/// function(std::integral_constant<std::size_t, i>) for i = 0 ... count - 1, without a loop.
template <std::size_t count, class Function>
NESTGRID_INLINE constexpr void unrolled(Function&& function) {
    [&]<std::size_t... i>(std::index_sequence<i...>) NESTGRID_INLINE_LAMBDA {
        (function(std::integral_constant<std::size_t, i>{}), ...);
    }
    (std::make_index_sequence<count>());
}

}  // namespace nestgrid
