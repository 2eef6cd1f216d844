// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

template void engine::walk_for(engine::ErasedBisectionVisitor<3, double>&,
                               const LatticeBisection<3>&,
                               const engine::MeanValues<LatticeBisection<3>>&,
                               const LatticeBisection<3>::Element&);

}  // namespace nestgrid
