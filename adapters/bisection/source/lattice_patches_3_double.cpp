// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

NESTGRID_INSTANTIATE_DOUBLES(3)
NESTGRID_INSTANTIATE_MEANS(double)
NESTGRID_INSTANTIATE_MEANS(std::int32_t)
NESTGRID_INSTANTIATE_MEANS(std::uint32_t)
NESTGRID_INSTANTIATE_MEANS(std::int64_t)
NESTGRID_INSTANTIATE_MEANS(std::uint64_t)

}  // namespace nestgrid
