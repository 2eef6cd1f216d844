// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
#include "stored.hpp"

int main(int count, char** arguments) {
    using namespace recording;
    record_family<BalancedQuadtree>("octree_grid2/balanced");
    record_family<UnbalancedQuadtree>("octree_grid2/unbalanced", false);
    return finish(count, arguments);
}
