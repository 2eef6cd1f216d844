// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template class Lattice<2>;
template class LatticeBisection<2>;
NESTGRID_INSTANTIATE(2, float, float)
NESTGRID_INSTANTIATE(2, std::int8_t, float)
NESTGRID_INSTANTIATE(2, std::uint8_t, float)
NESTGRID_INSTANTIATE(2, std::int16_t, float)
NESTGRID_INSTANTIATE(2, std::uint16_t, float)

}  // namespace nestgrid
