// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeBisection<3>, float>("lattice_bisection3");
    return finish(count, arguments);
}
