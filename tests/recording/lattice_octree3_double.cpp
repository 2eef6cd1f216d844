// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeOctree<3>, double>("lattice_octree3_double");
    return finish(count, arguments);
}
