// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// AlbertaGrid, of the dimension ALBERTA_DIM.
#include <dune/common/parallel/mpihelper.hh>

#include <nestgrid/adapters/dune_alberta.hpp>

#include "dune.hpp"
#include "dune_alberta_grids.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    using namespace nestgrid_test;
    constexpr int dim = alberta_dimension;
    Dune::MPIHelper::instance(count, arguments);
    const auto solver = bisected(dim, 2 * dim, 0.3);
    record_dune("dune_alberta" + std::to_string(dim) + "/bisected", *solver);
    return finish(count, arguments);
}
