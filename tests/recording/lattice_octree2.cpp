// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeOctree<2>, float>("lattice_octree2/float");
    record_lattices<LatticeOctree<2>, double>("lattice_octree2/double");
    return finish(count, arguments);
}
