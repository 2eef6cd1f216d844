// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template class Lattice<3>;
template class LatticeBisection<3>;
NESTGRID_INSTANTIATE_FLOATS(3)
NESTGRID_INSTANTIATE_MEANS(float)
NESTGRID_INSTANTIATE_MEANS(std::int8_t)
NESTGRID_INSTANTIATE_MEANS(std::uint8_t)
NESTGRID_INSTANTIATE_MEANS(std::int16_t)
NESTGRID_INSTANTIATE_MEANS(std::uint16_t)

}  // namespace nestgrid
