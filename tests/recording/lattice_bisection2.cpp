// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeBisection<2>, float>("lattice_bisection2/float");
    record_lattices<LatticeBisection<2>, double>("lattice_bisection2/double");
    return finish(count, arguments);
}
