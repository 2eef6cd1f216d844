// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of Dune's grids begin with MPI.
#include <gtest/gtest.h>
#include <dune/common/parallel/mpihelper.hh>

int main(int count, char** arguments) {
    Dune::MPIHelper::instance(count, arguments);
    testing::InitGoogleTest(&count, arguments);
    return RUN_ALL_TESTS();
}
