// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <nestgrid/keys.hpp>

namespace nestgrid::detail {

#ifdef NESTGRID_WIDE_KEYS
void library_has_keys_of_128_bits() {}
#else
void library_has_keys_of_64_bits() {}
#endif

void NESTGRID_SAME_LIBRARY() {}

}  // namespace nestgrid::detail
