// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <dune/common/parallel/mpihelper.hh>

#include "dune.hpp"
#include "dune_ug_grids.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    Dune::MPIHelper::instance(count, arguments);
    const auto hanging = hanging_cubes<3>(2, 2, 0.15);
    record_dune("dune_ug3/hanging", *hanging, true);
    const auto closed = cubes<3>(2);
    refine_at_sphere(*closed, 2, 0.15);
    record_dune("dune_ug3/closed_by_pyramids", *closed);
    const auto tetrahedra = simplices<3>(2);
    refine_at_sphere(*tetrahedra, 2, 0.15);
    record_dune("dune_ug3/tetrahedra", *tetrahedra);
    return finish(count, arguments);
}
