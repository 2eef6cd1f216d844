// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

NESTGRID_INSTANTIATE_DOUBLES(3)

}  // namespace nestgrid
