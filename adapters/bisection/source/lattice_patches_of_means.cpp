// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattice_patches.hpp"

namespace nestgrid {

void walk_means(const LatticeBisection<3>& grid,
                const engine::MeanValues<LatticeBisection<3>>& field,
                const LatticeBisection<3>::Element& e, const double* values, int level,
                int orientation, detail::ErasedBisectionVisitor<3, double>& visitor) {
    engine::walk_for(visitor, grid, field, e, values, level, orientation);
}

}  // namespace nestgrid
