// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template class Lattice<2>;
template class LatticeBisection<2>;
NESTGRID_INSTANTIATE_FLOATS(2)

}  // namespace nestgrid
