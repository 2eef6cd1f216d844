// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace nestgrid_test {

/// Calls of operator new so far, in programs that link counting_allocator.cpp.
std::size_t allocation_count();

}  // namespace nestgrid_test
