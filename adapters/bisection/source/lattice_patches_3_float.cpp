// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template class Lattice<3>;
template class LatticeBisection<3>;
NESTGRID_INSTANTIATE_FLOATS(3)

}  // namespace nestgrid
