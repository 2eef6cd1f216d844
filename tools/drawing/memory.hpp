// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

/// Bytes on the heap of this program, counted in operator new and delete. VTK's arrays are not
/// among them: what is counted is what the library allocates.
namespace memory {

std::size_t current();
std::size_t peak();
void reset_peak();  ///< to the current bytes

}  // namespace memory
