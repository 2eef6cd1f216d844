// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace nestgrid_test {

/// Calls of operator new so far, in programs that link counting_allocator.cpp.
std::size_t allocation_count();

/// Bytes that operator new has given out and not got back, as the heap rounds them.
std::size_t allocated_bytes();

}  // namespace nestgrid_test
