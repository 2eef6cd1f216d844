// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

NESTGRID_INSTANTIATE(3, double, double)
NESTGRID_INSTANTIATE(3, std::int32_t, double)
NESTGRID_INSTANTIATE(3, std::uint32_t, double)
NESTGRID_INSTANTIATE(3, std::int64_t, double)
NESTGRID_INSTANTIATE(3, std::uint64_t, double)

}  // namespace nestgrid
