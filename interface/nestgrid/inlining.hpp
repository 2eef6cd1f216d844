// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a compiler cannot guess of functions that call themselves: which to unroll, and which not.
#pragma once

#if defined(__GNUC__)
#define NESTGRID_INLINE [[gnu::always_inline]] inline
#define NESTGRID_INLINE_LAMBDA __attribute__((always_inline))
#define NESTGRID_NOINLINE [[gnu::noinline]]
#else
#define NESTGRID_INLINE inline
#define NESTGRID_INLINE_LAMBDA
#define NESTGRID_NOINLINE
#endif
