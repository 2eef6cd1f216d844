// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template class Lattice<3>;
template class LatticeBisection<3>;
NESTGRID_INSTANTIATE(3, float, float)
NESTGRID_INSTANTIATE(3, std::int8_t, float)
NESTGRID_INSTANTIATE(3, std::uint8_t, float)
NESTGRID_INSTANTIATE(3, std::int16_t, float)
NESTGRID_INSTANTIATE(3, std::uint16_t, float)

}  // namespace nestgrid
