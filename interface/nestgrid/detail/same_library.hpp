// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a program must share with the library. Its compiler refuses what cannot work at all. Where
// the standard library has another layout, the name that the linker does not find says which.
#pragma once

#include <version>

#if __cplusplus < 202002L
#error "nestgrid needs C++20: compile with -std=c++20 or later"
#endif
#ifndef __cpp_exceptions
#error "nestgrid reports errors by exceptions: compile without -fno-exceptions"
#endif

// Vectors tell AddressSanitizer what lies behind their end; all that fill them must.
#if defined(_GLIBCXX_SANITIZE_VECTOR) && defined(__SANITIZE_ADDRESS__)
#define NESTGRID_VECTORS_TELL_SANITIZER
#endif

namespace nestgrid::detail {

#if defined(_LIBCPP_VERSION)
#define NESTGRID_SAME_LIBRARY library_was_compiled_with_libcxx
#elif defined(_GLIBCXX_DEBUG)
#define NESTGRID_SAME_LIBRARY library_was_compiled_with_GLIBCXX_DEBUG
#elif defined(_GLIBCXX_USE_CXX11_ABI) && !_GLIBCXX_USE_CXX11_ABI
#define NESTGRID_SAME_LIBRARY library_was_compiled_with_GLIBCXX_USE_CXX11_ABI_0
#elif defined(NESTGRID_VECTORS_TELL_SANITIZER)
#define NESTGRID_SAME_LIBRARY library_was_compiled_with_GLIBCXX_SANITIZE_VECTOR
#else
#define NESTGRID_SAME_LIBRARY \
    library_was_compiled_without_GLIBCXX_DEBUG_and_with_GLIBCXX_USE_CXX11_ABI
#endif

/// Defined in the library under the name of what it was compiled with.
void NESTGRID_SAME_LIBRARY();

/// Asks for that name wherever a header of the interface is included.
[[gnu::used]] inline void (*const same_library)() = &NESTGRID_SAME_LIBRARY;

}  // namespace nestgrid::detail
