// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include <dune/common/parallel/mpihelper.hh>
#include <dune/grid/uggrid.hh>
#include <dune/grid/utility/structuredgridfactory.hh>

#include <nestgrid/adapters/dune.hpp>

int main(int argc, char** argv) {
    Dune::MPIHelper::instance(argc, argv);
    const auto ug =
        Dune::StructuredGridFactory<Dune::UGGrid<2>>::createSimplexGrid({0, 0}, {1, 1}, {2, 2});
    ug->globalRefine(1);
    const nestgrid::DuneGrid grid(*ug);
    std::printf("%zu triangles, %zu rules\n", grid.coarse_count(), grid.rules().size());
    return grid.coarse_count() == 8 && grid.rules().size() == 1 ? 0 : 1;
}
