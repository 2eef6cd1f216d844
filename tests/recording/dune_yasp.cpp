// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/yaspgrid.hh>

#include "dune.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    Dune::MPIHelper::instance(count, arguments);
    Dune::YaspGrid<2> squares({1, 1}, {3, 4});
    squares.globalRefine(2);
    record_dune("dune_yasp/2", squares);
    Dune::YaspGrid<3> cubes({1, 1, 1}, {1, 2, 1});
    cubes.globalRefine(2);
    record_dune("dune_yasp/3", cubes);
    return finish(count, arguments);
}
