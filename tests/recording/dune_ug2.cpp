// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <dune/common/parallel/mpihelper.hh>

#include "dune.hpp"
#include "dune_ug_grids.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    Dune::MPIHelper::instance(count, arguments);
    const auto hanging = hanging_cubes<2>(4, 3, 0.15);
    record_dune("dune_ug2/hanging", *hanging, true);
    const auto closed = cubes<2>(4);
    refine_at_sphere(*closed, 3, 0.15);
    record_dune("dune_ug2/closed", *closed);
    const auto triangles = simplices<2>(3);
    refine_at_sphere(*triangles, 3, 0.15);
    record_dune("dune_ug2/triangles", *triangles);
    return finish(count, arguments);
}
