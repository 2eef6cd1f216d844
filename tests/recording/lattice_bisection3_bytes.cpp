// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "lattices.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_lattices<LatticeBisection<3>, std::uint8_t>("lattice_bisection3_bytes");
    return finish(count, arguments);
}
