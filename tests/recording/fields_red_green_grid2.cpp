// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_fields<RedGreenMixed2>("fields_red_green_grid2", 3);
    return finish(count, arguments);
}
