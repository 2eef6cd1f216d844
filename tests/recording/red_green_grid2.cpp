// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_family<RedGreenMixed2>("red_green_grid2");
    return finish(count, arguments);
}
