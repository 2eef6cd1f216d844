// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_family<BalancedOctree>("octree_grid3/balanced");
    record_family<UnbalancedOctree>("octree_grid3/unbalanced", false);
    return finish(count, arguments);
}
