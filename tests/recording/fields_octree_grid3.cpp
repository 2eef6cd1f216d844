// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_fields<UnbalancedOctree>("fields_octree_grid3", 3);
    return finish(count, arguments);
}
