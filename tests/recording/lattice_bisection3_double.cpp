// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeBisection<3>, double>("lattice_bisection3_double");
    return finish(count, arguments);
}
