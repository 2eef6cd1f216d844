// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_fields<BisectionTetrahedra>("fields_bisection_grid3", 6);
    return finish(count, arguments);
}
