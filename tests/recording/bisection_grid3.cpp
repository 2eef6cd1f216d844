// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_family<BisectionTetrahedra>("bisection_grid3");
    return finish(count, arguments);
}
